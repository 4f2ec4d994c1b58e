#include "read/nori/properties.h"

#include "base/log.h"
#include "base/values.h"
#include "read/nori/names.h"
#include "read/nori/transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

namespace opal {

namespace {

const std::vector<std::string> object_tags = {"scene",      "mesh",    "bsdf",    "emitter", "camera",
                                              "integrator", "sampler", "rfilter", "test",    "texture"};
const std::vector<std::string> property_tags = {"boolean", "integer", "float", "string",
                                                "point",   "vector",  "color", "transform"};

bool contains(const std::vector<std::string> &names, const std::string &name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// Whether a value is that number, in all channels of a colour.
template <class Value> bool is_all(const Value &value, double x) {
    if (const auto *color = std::get_if<Color>(&value))
        return *color == Color{x, x, x};
    const auto *number = std::get_if<double>(&value);
    return number && *number == x;
}

// Points and vectors of a texture's plane have two numbers in some files.
Vec3 pair_or_triple(const std::string &text) {
    if (split(text).size() != 2)
        return parse_triple(text);
    const std::vector<double> pair = parse_numbers(text, 2);
    return {pair[0], pair[1], 0};
}

Color to_color(Vec3 v) { return {v.x, v.y, v.z}; }

} // namespace

Properties::Properties(const XmlNode &object, const ParseContext &context, bool has_type)
    : object_(object), context_(context), known_tag_(known_tag(object.tag())),
      mistakes_before_(context.mistakes ? context.mistakes->count() : 0) {
    if (known_tag_ == "texture") // its name is that of a parameter
        context.require_attributes(object, {"type"}, {"name"});
    else if (has_type)
        context.require_attributes(object, {"type"});
    else
        context.require_attributes(object, {});
    for (const XmlNode &node : object.children(context.handler())) {
        const std::string tag = known_tag(node.tag());
        if (contains(property_tags, tag))
            add_property(node);
        else if (contains(object_tags, tag))
            children_.push_back({node, tag});
        else {
            std::vector<std::string> tags = property_tags;
            tags.insert(tags.end(), object_tags.begin(), object_tags.end());
            context.unknown(node, unknown_name("tag", node.tag(), tags));
        }
    }
}

void Properties::unknown_type(const std::string &message, const std::string &instead) {
    has_unknown_type_ = true;
    if (object_.has_attribute("type")) // else it is told that it lacks one
        context_.unknown(object_, context_.lenient ? message + "; " + instead : message);
}

Properties::Value Properties::parse_value(const XmlNode &node) const {
    static const std::map<std::string, std::function<Value(const std::string &)>> parsers = {
        {"boolean", [](const std::string &text) { return parse_boolean(text); }},
        {"integer", [](const std::string &text) { return parse_integer(text); }},
        {"float", [](const std::string &text) { return parse_number(text); }},
        {"string", [](const std::string &text) { return text; }},
        {"point", [](const std::string &text) { return parse_triple(text); }},
        {"vector", [](const std::string &text) { return parse_triple(text); }},
        {"pair", [](const std::string &text) { return pair_or_triple(text); }},
        {"color", [](const std::string &text) { return to_color(parse_triple(text)); }},
    };
    if (node.tag() == "transform") {
        context_.require_attributes(node, {"name"});
        return parse_transform(node, context_);
    }
    if (!context_.require_attributes(node, {"name", "value"}))
        throw NoObject{}; // that is told
    node.require_empty();
    return at_place(node, [&] {
        try {
            const bool is_of_plane = known_tag_ == "texture" && (node.tag() == "point" || node.tag() == "vector");
            return parsers.at(is_of_plane ? "pair" : node.tag())(node.attribute("value"));
        } catch (const Error &error) {
            throw Error("property '" + node.attribute("name") + "': " + error.what());
        }
    });
}

void Properties::add_property(const XmlNode &node) {
    std::optional<Value> value;
    context_.attempt(node, [&] { value = parse_value(node); });
    if (!node.has_attribute("name"))
        return; // that is told
    std::string name = known_property(object_, node.attribute("name"));
    if (const Property *first = look(name))
        context_.mistake(node, "property '" + name + "' is repeated; it stands first at " + first->node.place().text());
    else {
        place_.emplace(name, properties_.size());
        properties_.push_back({node, name, std::move(value)});
    }
}

const Properties::Property *Properties::look(const std::string &name) const {
    const auto found = place_.find(name);
    return found == place_.end() ? nullptr : &properties_[found->second];
}

Properties::Property *Properties::ask(const std::string &name) {
    if (!contains(known_properties_, name))
        known_properties_.push_back(name);
    auto *property = const_cast<Property *>(look(name));
    if (property)
        property->asked = true;
    return property;
}

void Properties::wrong_type(Property &property, const std::string &tag) const {
    context_.mistake(property.node, "property '" + property.name + "' is a <" + property.node.tag() +
                                        "> here, but must be a <" + tag + ">");
    property.value.reset();
}

void Properties::lacks(const std::string &message) {
    if (!context_.mistakes)
        context_.mistake(object_, message);
    if (lacking_.empty())
        lacking_ = message;
}

void Properties::lacks_property(const std::string &name) {
    lacks("<" + object_.tag() + "> lacks its property '" + name + "'");
    throw NoObject{};
}

std::optional<bool> Properties::boolean_if(const std::string &name) {
    return has_other_type("boolean", name) ? std::nullopt : boolean(name);
}

std::optional<std::string> Properties::string_if(const std::string &name) {
    return has_other_type("string", name) ? std::nullopt : string(name);
}

std::optional<double> Properties::number_if(const std::string &name) {
    return has_other_type("float", name) ? std::nullopt : number(name);
}

std::optional<Vec3> Properties::point_if(const std::string &name) {
    return has_other_type("point", name) ? std::nullopt : point(name);
}

bool Properties::has_other_type(const char *tag, const std::string &name) const {
    const Property *property = look(name);
    return property && property->node.tag() != tag;
}

std::optional<std::string> Properties::text(const std::string &tag, const std::string &name) {
    const Property *written = look(name);
    bool taken = written && written->asked;
    Property *property = ask(name);
    if (!property || (taken && property->node.tag() != tag))
        return std::nullopt;
    if (property->value && property->node.tag() != tag)
        wrong_type(*property, tag);
    if (!property->value)
        return std::nullopt;
    return property->node.attribute("value");
}

void Properties::ignore(const std::string &name) { ask(name); }

void Properties::mistake_at(const std::string &name, const std::string &message) const {
    const Property *property = look(name);
    if (!property || property->value)
        context_.mistake(property ? property->node : object_, "property '" + name + "': " + message);
}

void Properties::fail_at(const std::string &name, const std::string &message) const {
    mistake_at(name, message);
    throw NoObject{};
}

SourcePlace Properties::place_of(const std::string &name) const {
    const Property *property = look(name);
    return (property ? property->node : object_).place();
}

std::vector<XmlNode> Properties::children(const std::string &tag) {
    known_children_.push_back(tag);
    std::vector<XmlNode> found;
    for (Child &child : children_)
        if (child.tag == tag) {
            child.asked = true;
            found.push_back(child.node);
        }
    return found;
}

std::optional<XmlNode> Properties::child(const std::string &tag) {
    std::vector<XmlNode> found = children(tag);
    for (size_t i = 1; i < found.size(); i++)
        context_.mistake(found[i], "a second <" + tag + "> in <" + object_.tag() + ">; the first stands at " +
                                       found[0].place().text());
    return found.empty() ? std::nullopt : std::optional(found[0]);
}

void Properties::tell_unfetched(const Property &property) const {
    const std::string type = object_.attribute("type"), place = property.node.place().text();
    const std::string of = type.empty() ? " of <scene>" : fmt::format(" of {} '{}'", known_tag_, type);
    const Leftover *leftover = find_leftover(object_, property.node.tag(), property.name);
    if (!leftover)
        return context_.unknown(property.node, unknown_name("property", property.name, known_properties_, of));
    if (!leftover->harmless || is_all(*property.value, *leftover->harmless))
        note(fmt::format("{}: property '{}'{} means nothing here", place, property.name, of));
    else
        warn(fmt::format("{}: property '{}'{}: {} is rendered as {}", place, property.name, of,
                         property.node.attribute("value"), *leftover->harmless));
}

void Properties::finish() const {
    if (has_unknown_type_)
        return;
    for (const Child &child : children_)
        if (!child.asked)
            context_.unknown(child.node,
                             "no <" + child.node.tag() + "> may stand in <" + object_.tag() + ">; " +
                                 (known_children_.empty() ? "no object may" : "available: " + joined(known_children_)));
    for (const Property &property : properties_)
        if (!property.asked && property.value)
            tell_unfetched(property);
    if (!lacking_.empty() && context_.mistakes->count() == mistakes_before_)
        context_.mistake(object_, lacking_);
}

} // namespace opal
