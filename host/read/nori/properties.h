// The properties and child objects of an XML object, fetched by type and name. One that is never fetched is a mistake.
#pragma once

#include "base/color.h"
#include "base/math.h"
#include "base/table.h"
#include "read/context.h"

#include <optional>
#include <unordered_map>
#include <variant>

namespace opal {

// Usage: fetch every property the object may have, check the values with check(), then call finish(). The constructor
// parses all values, so that a malformed value is a mistake even if its name is unknown. Where the context gathers
// mistakes, a property with a mistake is as one that is not given, and nothing more is said of it.
class Properties {
public:
    // Checks the attributes of the object: `type` alone, or none if the object has no types (<scene>).
    Properties(const XmlNode &object, const ParseContext &context, bool has_type = true);

    // The row of a table whose name is the object's `type`; null where there is none. That is a mistake, which lists
    // the types there are; if lenient, a warning that also says what is done `instead`. Properties that an unknown type
    // has are not looked at.
    template <class Rows> auto row_of_type(const Rows &rows, const std::string &instead) -> decltype(&*rows.begin()) {
        const std::string type = object_.attribute("type");
        for (const auto &row : rows)
            if (row.name == type)
                return &row;
        unknown_type(unknown_name(known_tag_ + " type", type, names_of(rows)), instead);
        return nullptr;
    }

    // The value, or nothing if it is not given. It is a mistake if it has another type.
    std::optional<bool> boolean(const std::string &name) { return find<bool>("boolean", name); }
    std::optional<int> integer(const std::string &name) { return find<int>("integer", name); }
    std::optional<double> number(const std::string &name) { return find<double>("float", name); }
    std::optional<std::string> string(const std::string &name) { return find<std::string>("string", name); }
    std::optional<Vec3> point(const std::string &name) { return find<Vec3>("point", name); }
    std::optional<Vec3> vector(const std::string &name) { return find<Vec3>("vector", name); }
    std::optional<Color> color(const std::string &name) { return find<Color>("color", name); }
    std::optional<Transform> transform(const std::string &name) { return find<Transform>("transform", name); }

    // The value. Throws NoObject if there is none, which is a mistake as lacks() tells it.
    template <class T> T required(const std::optional<T> &value, const std::string &name) {
        if (!value)
            lacks_property(name);
        return *value;
    }
    // A mistake at the object, which finish() tells unless there are other mistakes within the object: what is missing
    // may be what is misspelt there.
    void lacks(const std::string &message);

    // As boolean(), but nothing if the property has another type: for names that the dialects use with different types.
    // text() gets the value then.
    std::optional<bool> boolean_if(const std::string &name);
    std::optional<std::string> string_if(const std::string &name); // likewise, for numbers that may have a name
    std::optional<double> number_if(const std::string &name);      // likewise, for numbers that may be two
    std::optional<Vec3> point_if(const std::string &name);         // likewise, for points that may be vectors
    // The value as written, of a property of that type; nothing if it is missing or was fetched by boolean_if.
    std::optional<std::string> text(const std::string &tag, const std::string &name);

    bool has(const std::string &name) const { return look(name); } // whether it is given
    // Accepts the property, whatever its type, and ignores it.
    void ignore(const std::string &name);

    // A mistake at the place of the property, or of the object if the value is a default, unless `good`.
    void check(bool good, const std::string &name, const std::string &message) const {
        if (!good)
            mistake_at(name, message);
    }
    void mistake_at(const std::string &name, const std::string &message) const;
    [[noreturn]] void fail_at(const std::string &name, const std::string &message) const;

    std::optional<XmlNode> child(const std::string &tag); // at most one; of several, which is a mistake, the first
    std::vector<XmlNode> children(const std::string &tag);

    const XmlNode &object() const { return object_; }
    const ParseContext &context() const { return context_; }
    SourcePlace place_of(const std::string &name) const; // of the property, or of the object if it is missing
    void mistake(const std::string &message) const { context_.mistake(object_, message); } // at the object

    // Every property and child that was never fetched is a mistake; if lenient, it gets a warning. Leftovers (names.h)
    // get a note. Then tells what the object lacks.
    void finish() const;

private:
    using Value = std::variant<bool, int, double, std::string, Vec3, Color, Transform>;
    struct Property {
        XmlNode node;
        std::string name;
        std::optional<Value> value; // nothing: there is a mistake in it, which is told
        bool asked = false;
    };
    struct Child {
        XmlNode node;
        std::string tag; // as Opal knows it
        bool asked = false;
    };

    Value parse_value(const XmlNode &node) const;
    void add_property(const XmlNode &node);
    void unknown_type(const std::string &message, const std::string &instead);
    void tell_unfetched(const Property &property) const;
    [[noreturn]] void lacks_property(const std::string &name);
    Property *ask(const std::string &name);
    bool has_other_type(const char *tag, const std::string &name) const;
    const Property *look(const std::string &name) const;
    void wrong_type(Property &property, const std::string &tag) const;

    template <class T> std::optional<T> find(const char *tag, const std::string &name) {
        Property *property = ask(name);
        if (property && property->value && property->node.tag() != tag)
            wrong_type(*property, tag);
        if (!property || !property->value)
            return std::nullopt;
        return std::get<T>(*property->value);
    }

    XmlNode object_;
    ParseContext context_;
    std::string known_tag_; // of the object
    bool has_unknown_type_ = false;
    size_t mistakes_before_ = 0;
    std::string lacking_; // what the object lacks first, as a message
    std::vector<Property> properties_;
    std::unordered_map<std::string, size_t> place_; // in properties_, by name
    std::vector<Child> children_;
    std::vector<std::string> known_properties_, known_children_;
};

} // namespace opal
