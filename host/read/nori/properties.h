// The properties and child objects of an XML object, fetched by type and name. One that is never fetched is an error.
#pragma once

#include "base/error.h"
#include "base/table.h"
#include "base/values.h"
#include "read/xml.h"

#include <functional>
#include <optional>
#include <variant>

namespace opal {

// The context of parsing: the folder of the file, and the user's options.
struct ParseContext {
    std::filesystem::path folder; // of the XML file: relative file names are looked for there first
    bool lenient = false;         // an unknown property warns instead of failing
};

// Usage: fetch every property the object may have, check the values with check(), then call finish(). The constructor
// parses all values, so that a malformed value is an error even if its name is unknown.
class Properties {
public:
    // Checks the attributes of the object: `type` alone, or none if the object has no types (<scene>).
    Properties(const XmlNode &object, const ParseContext &context, bool has_type = true);

    // The value, or nothing if it is not given. Error if it has another type.
    std::optional<bool> boolean(const std::string &name) { return find<bool>("boolean", name); }
    std::optional<int> integer(const std::string &name) { return find<int>("integer", name); }
    std::optional<double> number(const std::string &name) { return find<double>("float", name); }
    std::optional<std::string> string(const std::string &name) { return find<std::string>("string", name); }
    std::optional<Vec3> point(const std::string &name) { return find<Vec3>("point", name); }
    std::optional<Vec3> vector(const std::string &name) { return find<Vec3>("vector", name); }
    std::optional<Color> color(const std::string &name) { return find<Color>("color", name); }
    std::optional<Transform> transform(const std::string &name) { return find<Transform>("transform", name); }

    // The value, or an Error if it is not given.
    template <class T> T required(const std::optional<T> &value, const std::string &name) const {
        if (!value)
            fail("<" + object_.tag() + "> lacks its property '" + name + "'");
        return *value;
    }

    // As boolean(), but nothing if the property has another type: for names that the dialects use with different types.
    // text() gets the value then.
    std::optional<bool> boolean_if(const std::string &name);
    // The value as written, of a property of that type; nothing if it is missing or was fetched by boolean_if.
    std::optional<std::string> text(const std::string &tag, const std::string &name);

    // Accepts the property, whatever its type, and ignores it.
    void ignore(const std::string &name);

    // Error at the place of the property, or of the object if the value is a default, unless `good`.
    void check(bool good, const std::string &name, const std::string &message) const {
        if (!good)
            fail_at(name, message);
    }
    [[noreturn]] void fail_at(const std::string &name, const std::string &message) const;

    std::optional<XmlNode> child(const std::string &tag); // at most one
    std::vector<XmlNode> children(const std::string &tag);

    const XmlNode &object() const { return object_; }
    const ParseContext &context() const { return context_; }
    SourcePlace place_of(const std::string &name) const; // of the property, or of the object if it is missing
    [[noreturn]] void fail(const std::string &message) const { object_.fail(message); }

    // Error at the first property or child that was never fetched. With `lenient`, properties get a warning instead.
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

// Runs `parse` and adds the place of this node to its Error.
template <class Parse> decltype(auto) at_place(const XmlNode &node, Parse parse) {
    try {
        return parse();
    } catch (const Error &error) {
        node.fail(error.what());
    }
}

// The row of a table whose name is the object's `type`. Error that lists the types there are.
template <class Rows> const auto &row_of_type(const XmlNode &object, const Rows &rows) {
    object.require_attributes({"type"});
    std::string type = object.attribute("type");
    for (const auto &row : rows)
        if (row.name == type)
            return row;
    object.fail(unknown_name(object.tag() + " type", type, names_of(rows)));
}

} // namespace opal
