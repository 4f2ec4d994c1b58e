#include "read/nori/properties.h"

#include "base/log.h"
#include "read/nori/transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace opal {

namespace {

const std::vector<std::string> object_tags = {"scene",      "mesh",    "bsdf",    "emitter", "camera",
                                              "integrator", "sampler", "rfilter", "test"};
const std::vector<std::string> property_tags = {"boolean", "integer", "float", "string",
                                                "point",   "vector",  "color", "transform"};

bool contains(const std::vector<std::string> &names, const std::string &name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

Color to_color(Vec3 v) { return {v.x, v.y, v.z}; }

} // namespace

Properties::Properties(const XmlNode &object, const ParseContext &context, bool has_type)
    : object_(object), context_(context) {
    if (has_type)
        object.require_attributes({"type"});
    else
        object.require_attributes({});
    for (const XmlNode &node : object.children()) {
        if (contains(property_tags, node.tag()))
            add_property(node);
        else if (contains(object_tags, node.tag()))
            children_.push_back({node});
        else {
            std::vector<std::string> tags = property_tags;
            tags.insert(tags.end(), object_tags.begin(), object_tags.end());
            node.fail(unknown_name("tag", node.tag(), tags));
        }
    }
}

Properties::Value Properties::parse_value(const XmlNode &node) {
    static const std::map<std::string, std::function<Value(const std::string &)>> parsers = {
        {"boolean", [](const std::string &text) { return parse_boolean(text); }},
        {"integer", [](const std::string &text) { return parse_integer(text); }},
        {"float", [](const std::string &text) { return parse_number(text); }},
        {"string", [](const std::string &text) { return text; }},
        {"point", [](const std::string &text) { return parse_triple(text); }},
        {"vector", [](const std::string &text) { return parse_triple(text); }},
        {"color", [](const std::string &text) { return to_color(parse_triple(text)); }},
    };
    if (node.tag() == "transform") {
        node.require_attributes({"name"});
        return parse_transform(node);
    }
    node.require_attributes({"name", "value"});
    if (!node.children().empty())
        node.children().front().fail("<" + node.tag() + "> holds nothing");
    return at_place(node, [&] {
        try {
            return parsers.at(node.tag())(node.attribute("value"));
        } catch (const Error &error) {
            throw Error("property '" + node.attribute("name") + "': " + error.what());
        }
    });
}

void Properties::add_property(const XmlNode &node) {
    Value value = parse_value(node);
    std::string name = node.attribute("name");
    if (const Property *first = look(name))
        node.fail("property '" + name + "' is repeated; it stands first at " + first->node.place().text());
    properties_.push_back({node, name, std::move(value)});
}

const Properties::Property *Properties::look(const std::string &name) const {
    auto found =
        std::find_if(properties_.begin(), properties_.end(), [&](const Property &p) { return p.name == name; });
    return found == properties_.end() ? nullptr : &*found;
}

Properties::Property *Properties::ask(const std::string &name) {
    if (!contains(known_properties_, name))
        known_properties_.push_back(name);
    auto *property = const_cast<Property *>(look(name));
    if (property)
        property->asked = true;
    return property;
}

void Properties::wrong_type(const Property &property, const std::string &tag) const {
    property.node.fail("property '" + property.name + "' is a <" + property.node.tag() + "> here, but must be a <" +
                       tag + ">");
}

std::optional<bool> Properties::boolean_if(const std::string &name) {
    const Property *property = look(name);
    return property && property->node.tag() != "boolean" ? std::nullopt : boolean(name);
}

std::optional<std::string> Properties::text(const std::string &tag, const std::string &name) {
    const Property *written = look(name);
    bool taken = written && written->asked;
    const Property *property = ask(name);
    if (!property || (taken && property->node.tag() != tag))
        return std::nullopt;
    if (property->node.tag() != tag)
        wrong_type(*property, tag);
    return property->node.attribute("value");
}

void Properties::ignore(const std::string &name) { ask(name); }

void Properties::fail_at(const std::string &name, const std::string &message) const {
    const Property *property = look(name);
    (property ? property->node : object_).fail("property '" + name + "': " + message);
}

SourcePlace Properties::place_of(const std::string &name) const {
    const Property *property = look(name);
    return (property ? property->node : object_).place();
}

std::vector<XmlNode> Properties::children(const std::string &tag) {
    known_children_.push_back(tag);
    std::vector<XmlNode> found;
    for (Child &child : children_)
        if (child.node.tag() == tag) {
            child.asked = true;
            found.push_back(child.node);
        }
    return found;
}

std::optional<XmlNode> Properties::child(const std::string &tag) {
    std::vector<XmlNode> found = children(tag);
    if (found.size() > 1)
        found[1].fail("a second <" + tag + "> in <" + object_.tag() + ">; the first stands at " +
                      found[0].place().text());
    return found.empty() ? std::nullopt : std::optional(found[0]);
}

void Properties::finish() const {
    for (const Child &child : children_)
        if (!child.asked)
            child.node.fail("no <" + child.node.tag() + "> may stand in <" + object_.tag() + ">; " +
                            (known_children_.empty() ? "no object may" : "available: " + joined(known_children_)));
    for (const Property &property : properties_) {
        if (property.asked)
            continue;
        std::string type = object_.attribute("type");
        std::string of = type.empty() ? " of <scene>" : fmt::format(" of {} '{}'", object_.tag(), type);
        std::string message = unknown_name("property", property.name, known_properties_, of);
        if (!context_.lenient)
            property.node.fail(message);
        warn(property.node.place().text() + ": " + message);
    }
}

} // namespace opal
