// XML elements that know their place in the file, so that every error can say file:line:col.
#pragma once

#include "scene/scene.h"

#include <pugixml.hpp>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace opal {

// Line and column of a byte offset in a file's text, from 1; columns count characters of UTF-8.
SourcePlace place_in(const std::string &file, std::string_view text, ptrdiff_t offset);

class XmlDocument;

// An element. Valid as long as its document; cheap to copy.
class XmlNode {
public:
    XmlNode(const XmlDocument &document, pugi::xml_node node) : document_(&document), node_(node) {}

    std::string tag() const { return node_.name(); }
    SourcePlace place() const; // of the '<'
    std::string attribute(const char *name) const { return node_.attribute(name).value(); }
    // The child elements, in document order. Text between them is an Error.
    std::vector<XmlNode> children() const;
    // Throws Error unless the element has exactly these attributes, each once.
    void require_attributes(std::initializer_list<const char *> names) const;
    [[noreturn]] void fail(const std::string &message) const; // Error "file:line:col: message"

private:
    const XmlDocument *document_;
    pugi::xml_node node_;
};

class XmlDocument {
public:
    // Reads and parses a file. Throws Error at the place of the first mistake.
    explicit XmlDocument(const std::filesystem::path &file);
    // Parses `text`; errors name `file`.
    XmlDocument(const std::filesystem::path &file, std::string text);
    XmlDocument(const XmlDocument &) = delete;
    XmlDocument &operator=(const XmlDocument &) = delete;

    XmlNode root() const; // the one root element
    SourcePlace place(ptrdiff_t offset) const { return place_in(file_, text_, offset); }
    const std::string &text() const { return text_; }

private:
    std::string file_, text_;
    pugi::xml_document document_;
};
} // namespace opal
