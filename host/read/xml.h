// XML elements that know their place in the file, so that every error can say file:line:col.
#pragma once

#include "base/error.h"
#include "base/hash.h"
#include "scene/place.h"

#include <pugixml.hpp>

#include <filesystem>
#include <functional>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace opal {

// Line and column of a byte offset in a file's text, from 1; columns count characters of UTF-8.
SourcePlace place_in(const std::string &file, std::string_view text, ptrdiff_t offset);

// An Error "file:line:col: message".
class XmlError : public Error {
public:
    XmlError(const SourcePlace &place, const std::string &message)
        : Error(place.text() + ": " + message), place_(place) {}
    const SourcePlace &place() const { return place_; }

private:
    SourcePlace place_;
};

// Takes a mistake and lets the caller go on. An empty one throws XmlError.
using MistakeHandler = std::function<void(const SourcePlace &, const std::string &message)>;
// Takes an attribute that is not among those wanted, and the sentence that says so. An empty one throws XmlError.
using AttributeHandler = std::function<void(const std::string &name, const std::string &message)>;

// The values of names that attributes give as $name.
using Definitions = std::map<std::string, std::string>;
// Letters, digits and '_', with no digit first.
bool is_definable(std::string_view name);
// The sentence for a $name without a value.
std::string no_value_text(const std::string &name, const std::vector<std::string> &known);

// The places of a text, marked once: one is then found in logarithmic time, so that files of 1e5 objects load.
class TextLines {
public:
    TextLines(std::string file, std::string_view text); // the text must outlive this
    SourcePlace place(ptrdiff_t offset) const;          // as place_in

private:
    struct Mark { // at each line's start, and now and then within a long one
        size_t offset;
        int line, column;
    };
    std::string file_;
    std::string_view text_;
    std::vector<Mark> marks_;
};

class XmlDocument;

// An element. Valid as long as its document; cheap to copy.
class XmlNode {
public:
    XmlNode(const XmlDocument &document, pugi::xml_node node) : document_(&document), node_(node) {}

    std::string tag() const { return node_.name(); }
    SourcePlace place() const; // of the '<'
    std::string attribute(const char *name) const { return node_.attribute(name).value(); }
    bool has_attribute(const char *name) const { return !node_.attribute(name).empty(); }
    // The child elements, in document order. Text between them is a mistake.
    std::vector<XmlNode> children(const MistakeHandler &mistake = {}) const;
    // It is a mistake unless the element has exactly these attributes, each once, and of the optional ones any. Returns
    // whether it has all.
    bool require_attributes(std::initializer_list<const char *> names, const MistakeHandler &mistake = {},
                            const AttributeHandler &unknown = {},
                            std::initializer_list<const char *> optional = {}) const;
    void require_empty() const; // throws XmlError at the first element within it
    // Puts what `edit` makes of it in the place of each attribute's value that holds a '$'.
    void edit_attributes(const std::function<std::string(const std::string &)> &edit) const;
    [[noreturn]] void fail(const std::string &message) const; // throws XmlError

private:
    const XmlDocument *document_;
    pugi::xml_node node_;
};

class XmlDocument {
public:
    // Reads and parses a file. Throws Error at the place of the first mistake.
    explicit XmlDocument(const std::filesystem::path &file, FileHashes *hashes = nullptr);
    // Parses `text`; errors name `file`.
    XmlDocument(const std::filesystem::path &file, std::string text);
    XmlDocument(const XmlDocument &) = delete;
    XmlDocument &operator=(const XmlDocument &) = delete;

    XmlNode root() const; // the one root element

    // Puts the value of the name in the place of each $name in attributes, and returns the values that were used. A
    // value is that of `given`, else that of a <default name="..." value="..."/> directly in a <scene>; these are taken
    // out of the document. It is not looked at again, so that it may hold a '$'. A '$' before no name stays. A name
    // without a value is a mistake; then, values of `given` that nothing names throw UsageError.
    Definitions define(const Definitions &given, const MistakeHandler &mistake = {});
    SourcePlace place(ptrdiff_t offset) const { return lines_.place(offset); }
    const std::string &text() const { return text_; }

private:
    std::string text_;
    TextLines lines_;
    pugi::xml_document document_;
};
} // namespace opal
