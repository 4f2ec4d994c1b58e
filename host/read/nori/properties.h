// The properties and child objects of an XML object, fetched by type and name. What nobody asked for is an error.
#pragma once

#include "base/error.h"
#include "base/table.h"
#include "base/values.h"
#include "read/xml.h"

#include <functional>
#include <optional>
#include <variant>

namespace opal {

// What parsing needs to know beside the XML itself.
struct ParseContext {
    std::filesystem::path folder; // of the XML file: relative file names are looked for there first
    bool lenient = false;         // an unknown property warns instead of failing
};

// Usage: fetch everything that may be there, use place_of / fail for values that make no sense, then call finish().
// All values are parsed by the constructor, so that a malformed one is an error even where its name is unknown.
class Properties {
public:
    // Checks the object's attributes: `type` alone, or none where it has no types (<scene>).
    Properties(const XmlNode &object, const ParseContext &context, bool has_type = true);

    // The value, or nothing where it was not written; an Error where it has another type.
    std::optional<bool> boolean(const std::string &name) { return find<bool>("boolean", name); }
    std::optional<int> integer(const std::string &name) { return find<int>("integer", name); }
    std::optional<double> number(const std::string &name) { return find<double>("float", name); }
    std::optional<std::string> string(const std::string &name) { return find<std::string>("string", name); }
    std::optional<Vec3> point(const std::string &name) { return find<Vec3>("point", name); }
    std::optional<Vec3> vector(const std::string &name) { return find<Vec3>("vector", name); }
    std::optional<Color> color(const std::string &name) { return find<Color>("color", name); }
    std::optional<Transform> transform(const std::string &name) { return find<Transform>("transform", name); }

    // The value, which must be there.
    template <class T> T required(const std::optional<T> &value, const std::string &name) const {
        if (!value)
            fail("<" + object_.tag() + "> lacks its property '" + name + "'");
        return *value;
    }

    // As boolean, but nothing where the property has another type: for names that two dialects use differently. What is
    // left can be asked for by text().
    std::optional<bool> boolean_if(const std::string &name);
    // The value as written, of a property of that type; nothing where it is missing or was taken by boolean_if.
    std::optional<std::string> text(const std::string &tag, const std::string &name);

    // Known and accepted, whatever its type, but without a meaning.
    void ignore(const std::string &name);

    // A check of a value: fails at its place, or at the object's where the value is a default.
    void check(bool good, const std::string &name, const std::string &message) const {
        if (!good)
            fail_at(name, message);
    }
    [[noreturn]] void fail_at(const std::string &name, const std::string &message) const;

    std::optional<XmlNode> child(const std::string &tag); // at most one
    std::vector<XmlNode> children(const std::string &tag);

    const XmlNode &object() const { return object_; }
    const ParseContext &context() const { return context_; }
    SourcePlace place_of(const std::string &name) const; // of the property, or of the object without it
    [[noreturn]] void fail(const std::string &message) const { object_.fail(message); }

    // Every property and child that was never asked for is an Error (a warning, for properties, if lenient).
    void finish() const;

private:
    using Value = std::variant<bool, int, double, std::string, Vec3, Color, Transform>;
    struct Property {
        XmlNode node;
        std::string name;
        Value value;
        bool asked = false;
    };
    struct Child {
        XmlNode node;
        bool asked = false;
    };

    static Value parse_value(const XmlNode &node);
    void add_property(const XmlNode &node);
    Property *ask(const std::string &name);
    const Property *look(const std::string &name) const;
    [[noreturn]] void wrong_type(const Property &property, const std::string &tag) const;

    template <class T> std::optional<T> find(const char *tag, const std::string &name) {
        Property *property = ask(name);
        if (!property)
            return std::nullopt;
        if (property->node.tag() != tag)
            wrong_type(*property, tag);
        return std::get<T>(property->value);
    }

    XmlNode object_;
    ParseContext context_;
    std::vector<Property> properties_;
    std::vector<Child> children_;
    std::vector<std::string> known_properties_, known_children_;
};

// Runs `parse`; its Error gets the place of this node.
template <class Parse> decltype(auto) at_place(const XmlNode &node, Parse parse) {
    try {
        return parse();
    } catch (const Error &error) {
        node.fail(error.what());
    }
}

// The row of a table that the object's `type` names; the Error lists the types of its tag.
template <class Rows> const auto &row_of_type(const XmlNode &object, const Rows &rows) {
    object.require_attributes({"type"});
    std::string type = object.attribute("type");
    for (const auto &row : rows)
        if (row.name == type)
            return row;
    object.fail(unknown_name(object.tag() + " type", type, names_of(rows)));
}

} // namespace opal
