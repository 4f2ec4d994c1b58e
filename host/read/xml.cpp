#include "read/xml.h"

#include "base/read_file.h"
#include "base/table.h"
#include "read/file_kind.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <set>

namespace opal {

namespace {

void tell(const MistakeHandler &mistake, const SourcePlace &place, const std::string &message) {
    if (!mistake)
        throw XmlError(place, message);
    mistake(place, message);
}

// Takes a byte order mark, which would shift every offset, from the text.
std::string_view without_mark(std::string &text) {
    if (text.starts_with("\xef\xbb\xbf"))
        text.erase(0, 3);
    return text;
}

// How many characters of UTF-8 begin in the text.
int characters(std::string_view text) {
    return int(std::ranges::count_if(text, [](char c) { return (c & 0xc0) != 0x80; }));
}

bool is_text(pugi::xml_node node) { return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata; }

// The child elements of a node. Text that is not blank is a mistake.
std::vector<XmlNode> elements_of(const XmlDocument &document, pugi::xml_node parent, const MistakeHandler &mistake) {
    std::vector<XmlNode> elements;
    for (pugi::xml_node child : parent.children()) {
        if (is_text(child)) {
            size_t start = document.text().find_first_not_of(" \t\r\n", size_t(child.offset_debug()));
            tell(mistake, document.place(ptrdiff_t(start)),
                 "text between the tags: nothing but tags and comments may stand here");
        }
        if (child.type() == pugi::node_element)
            elements.emplace_back(document, child);
    }
    return elements;
}

// The first element that is nested too deep for parsers, which call themselves for each level.
class TooDeep : public pugi::xml_tree_walker {
public:
    static constexpr int most_levels = 64; // scenes of Nori have about 6
    bool for_each(pugi::xml_node &node) override {
        if (depth() < most_levels || node.type() != pugi::node_element)
            return true;
        found = node;
        return false;
    }
    pugi::xml_node found;
};

} // namespace

SourcePlace place_in(const std::string &file, std::string_view text, ptrdiff_t offset) {
    auto end = text.begin() + std::clamp<ptrdiff_t>(offset, 0, ptrdiff_t(text.size()));
    auto line = std::count(text.begin(), end, '\n');
    auto start = std::find(std::make_reverse_iterator(end), text.rend(), '\n').base();
    return {file, int(line) + 1, characters({start, end}) + 1};
}

TextLines::TextLines(std::string file, std::string_view text) : file_(std::move(file)), text_(text), marks_{{0, 1, 1}} {
    constexpr size_t apart = 1024; // so that a file that is one long line has places in little time, too
    for (size_t at = 0; at < text.size();) {
        const std::string_view next = text.substr(at, apart);
        const size_t end = at + std::min(next.find('\n'), next.size());
        const bool is_end = end < text.size() && text[end] == '\n';
        const Mark &last = marks_.back();
        marks_.push_back(is_end ? Mark{end + 1, last.line + 1, 1}
                                : Mark{end, last.line, last.column + characters(text.substr(at, end - at))});
        at = marks_.back().offset;
    }
}

SourcePlace TextLines::place(ptrdiff_t offset) const {
    const size_t end = size_t(std::clamp<ptrdiff_t>(offset, 0, ptrdiff_t(text_.size())));
    const Mark &mark = *(std::ranges::upper_bound(marks_, end, {}, &Mark::offset) - 1);
    return {file_, mark.line, mark.column + characters(text_.substr(mark.offset, end - mark.offset))};
}

SourcePlace XmlNode::place() const { return document_->place(node_.offset_debug() - 1); }

std::vector<XmlNode> XmlNode::children(const MistakeHandler &mistake) const {
    return elements_of(*document_, node_, mistake);
}

bool XmlNode::require_attributes(std::initializer_list<const char *> names, const MistakeHandler &mistake,
                                 const AttributeHandler &unknown, std::initializer_list<const char *> optional) const {
    constexpr ptrdiff_t most_attributes = 1000; // each is looked for among all
    if (const auto all = node_.attributes(); std::distance(all.begin(), all.end()) > most_attributes)
        fail(fmt::format("<{}> has more than {} attributes", tag(), most_attributes));
    std::vector<std::string> known(names.begin(), names.end());
    known.insert(known.end(), optional.begin(), optional.end());
    std::set<std::string> seen;
    for (pugi::xml_attribute attribute : node_.attributes()) {
        std::string name = attribute.name();
        if (!seen.insert(name).second)
            tell(mistake, place(), fmt::format("<{}> has the attribute '{}' twice", tag(), name));
        if (std::find(known.begin(), known.end(), name) != known.end())
            continue;
        const std::string message = unknown_name("attribute", name, known, fmt::format(" of <{}>", tag()));
        if (!unknown)
            fail(message);
        unknown(name, message);
    }
    bool has_all = true;
    for (const char *name : names)
        if (!seen.contains(name)) {
            tell(mistake, place(), fmt::format("<{}> lacks the attribute '{}'", tag(), name));
            has_all = false;
        }
    return has_all;
}

void XmlNode::require_empty() const {
    if (const std::vector<XmlNode> within = children(); !within.empty())
        within.front().fail(fmt::format("<{}> holds nothing", tag()));
}

void XmlNode::edit_attributes(const std::function<std::string(const std::string &)> &edit) const {
    for (pugi::xml_attribute attribute : node_.attributes())
        if (const std::string_view text = attribute.value(); text.find('$') != text.npos)
            attribute.set_value(edit(std::string(text)).c_str());
}

void XmlNode::fail(const std::string &message) const { throw XmlError(place(), message); }

XmlDocument::XmlDocument(const std::filesystem::path &file, FileHashes *hashes)
    : XmlDocument(file, read_text_file(file, FileKind::scene, hashes)) {}

XmlDocument::XmlDocument(const std::filesystem::path &file, std::string text)
    : text_(std::move(text)), lines_(file.string(), without_mark(text_)) {
    // Parsed as a fragment: pugixml would skip text and further roots beside the root.
    pugi::xml_parse_result result = document_.load_buffer(
        text_.data(), text_.size(), pugi::parse_default | pugi::parse_fragment, pugi::encoding_utf8);
    if (result.status == pugi::status_out_of_memory)
        cannot_read(file, ENOMEM);
    if (!result)
        throw XmlError(place(result.offset), std::string("not well-formed XML: ") + result.description());
    TooDeep walker;
    document_.traverse(walker);
    if (walker.found)
        XmlNode(*this, walker.found).fail(fmt::format("more than {} tags within each other", TooDeep::most_levels));
}

namespace {

bool is_name_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

bool begins_name(char c) { return is_name_letter(c) && !std::isdigit(static_cast<unsigned char>(c)); }

// Takes the <default>s out of the <scene>s below `parent`, in document order, and returns their values.
Definitions take_defaults(const XmlDocument &document, pugi::xml_node parent, const MistakeHandler &mistake) {
    Definitions defaults;
    for (pugi::xml_node child = parent.first_child(), next; child; child = next) {
        next = child.next_sibling();
        if (std::string_view(child.name()) != "default" || std::string_view(parent.name()) != "scene") {
            defaults.merge(take_defaults(document, child, mistake));
            continue;
        }
        const XmlNode node(document, child);
        node.require_attributes({"name", "value"}, mistake);
        const std::string name = node.attribute("name");
        if (node.has_attribute("name") && !is_definable(name))
            tell(mistake, node.place(), fmt::format("'{}' is no name: letters, digits and '_', no digit first", name));
        if (!defaults.emplace(name, node.attribute("value")).second)
            tell(mistake, node.place(), fmt::format("a second <default> of '{}'", name));
        parent.remove_child(child);
    }
    return defaults;
}

// Replaces names in attributes, and keeps what was used.
class Replacer : public pugi::xml_tree_walker {
public:
    Replacer(const XmlDocument &document, const Definitions &values, const MistakeHandler &mistake)
        : document_(document), values_(values), mistake_(mistake) {}

    bool for_each(pugi::xml_node &node) override {
        XmlNode(document_, node).edit_attributes([&](const std::string &text) { return replaced(node, text); });
        return true;
    }
    Definitions used;
    bool lacks_some = false;

private:
    std::string replaced(pugi::xml_node node, const std::string &text) {
        std::string result;
        for (size_t i = 0; i < text.size();) {
            if (text[i] != '$' || i + 1 == text.size() || !begins_name(text[i + 1])) {
                result += text[i++];
                continue;
            }
            const auto end = std::find_if_not(text.begin() + std::ptrdiff_t(i) + 1, text.end(), is_name_letter);
            const std::string name(text.begin() + std::ptrdiff_t(i) + 1, end);
            i += 1 + name.size();
            if (const auto value = values_.find(name); value != values_.end()) {
                result += value->second;
                used.insert(*value);
            } else {
                lack(node, name);
            }
        }
        return result;
    }

    void lack(pugi::xml_node node, const std::string &name) {
        lacks_some = true;
        if (known_.empty())
            for (const auto &[other, value] : values_)
                known_.push_back(other);
        tell(mistake_, XmlNode(document_, node).place(), no_value_text(name, known_));
    }

    const XmlDocument &document_;
    const Definitions &values_;
    const MistakeHandler &mistake_;
    std::vector<std::string> known_; // names, once one is lacking
};

} // namespace

bool is_definable(std::string_view name) {
    return !name.empty() && begins_name(name[0]) && std::all_of(name.begin(), name.end(), is_name_letter);
}

std::string no_value_text(const std::string &name, const std::vector<std::string> &known) {
    const std::string nearest = nearest_name(name, known);
    return fmt::format("${} has no value{}: -D {}=VALUE gives one, or <default name=\"{}\" value=\"...\"/> in <scene>",
                       name, nearest.empty() ? "" : fmt::format("; did you mean '${}'?", nearest), name, name);
}

Definitions XmlDocument::define(const Definitions &given, const MistakeHandler &mistake) {
    Definitions values = given;
    values.merge(take_defaults(*this, document_, mistake)); // what is given stays
    Replacer replacer(*this, values, mistake);
    document_.traverse(replacer);
    for (const auto &[name, value] : given)
        if (!replacer.used.contains(name) && !replacer.lacks_some) {
            std::vector<std::string> known;
            for (const auto &[other, used] : replacer.used)
                known.push_back(other);
            throw UsageError(root().place().text() + ": " + unknown_name("name of -D", name, known) +
                             fmt::format(": no attribute holds ${}", name));
        }
    return replacer.used;
}

XmlNode XmlDocument::root() const {
    const auto first = document_.begin();
    if (first != document_.end() && std::all_of(first, document_.end(), is_text))
        throw XmlError(place(ptrdiff_t(text_.find_first_not_of(" \t\r\n"))), "is no XML: it holds no tags");
    std::vector<XmlNode> roots = elements_of(*this, document_, {});
    if (roots.empty())
        throw XmlError(place(0), "holds no <scene>");
    if (roots.size() > 1)
        roots[1].fail("a second root <" + roots[1].tag() + ">; a file holds one");
    return roots[0];
}

} // namespace opal
