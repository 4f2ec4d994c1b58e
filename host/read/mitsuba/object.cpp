#include "read/mitsuba/object.h"

#include "base/log.h"
#include "read/mitsuba/document.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace opal::mitsuba {

namespace {

bool contains(const std::vector<std::string> &names, const std::string &name) {
    return std::ranges::find(names, name) != names.end();
}

void add_new(std::vector<std::string> &names, const std::string &name) {
    if (!contains(names, name))
        names.push_back(name);
}

// What a curve has outside of what can be. Mitsuba clamps it, too.
Color clamped(const XmlNode &node, const Color &color, SpectrumUse use) {
    const double most = use == SpectrumUse::reflectance ? 1 : std::numeric_limits<double>::infinity();
    Color result = color;
    for (double &c : result)
        c = std::clamp(c, 0.0, most);
    if (result != color)
        warn(fmt::format("{}: this spectrum has the linear RGB {:.4g}, {:.4g}, {:.4g}; it is clamped to {}",
                         node.place().text(), color[0], color[1], color[2],
                         use == SpectrumUse::reflectance ? "0 to 1" : "0 and more"));
    return result;
}

} // namespace

Object::Object(Document &document, size_t index, const XmlNode &node, std::string name)
    : document_(&document), index_(index), node_(node), tag_(node.tag()), type_(node.attribute("type")),
      id_(node.attribute("id")), name_(std::move(name)) {}

const std::string &Object::tag() const { return tag_; }
const std::string &Object::type() const { return type_; }
const std::string &Object::id() const { return id_; }
const std::string &Object::name() const { return name_; }
SourcePlace Object::place() const { return node_.place(); }
const ParseContext &Object::context() const { return document_->context(); }

const Object::Property *Object::look(const std::string &name) const {
    const auto found = std::ranges::find(properties_, name, &Property::name);
    return name.empty() || found == properties_.end() ? nullptr : &*found;
}

Object::Property *Object::ask(const std::string &name) {
    add_new(known_properties_, name);
    auto *property = const_cast<Property *>(look(name));
    if (property)
        property->asked = true;
    return property;
}

// The property, or null if it is not given, or has a mistake, or is none of these tags: that is one.
Object::Property *Object::ask(const std::string &name, std::initializer_list<const char *> tags) {
    Property *property = ask(name);
    if (!property || std::holds_alternative<std::monostate>(property->value))
        return nullptr;
    const bool is_transform = std::holds_alternative<std::unique_ptr<Transform>>(property->value); // of an old uscale
    const std::string tag = is_transform ? "transform" : property->node.tag();
    const bool is_object = std::holds_alternative<Object *>(property->value);
    if (!is_object && std::ranges::any_of(tags, [&](const char *wanted) { return tag == wanted; }))
        return property;
    std::string wanted;
    for (const char *each : tags)
        wanted += fmt::format("{}<{}>", wanted.empty() ? "" : " or ", each);
    context().mistake(property->node, fmt::format("property '{}' is a <{}> here, but must be a {}", name, tag, wanted));
    property->value = std::monostate();
    return nullptr;
}

template <class T> std::optional<T> Object::find(const std::string &name, std::initializer_list<const char *> tags) {
    const Property *property = ask(name, tags);
    return property ? std::optional(std::get<T>(property->value)) : std::nullopt;
}

std::optional<bool> Object::boolean(const std::string &name) { return find<bool>(name, {"boolean"}); }
std::optional<int> Object::integer(const std::string &name) { return find<int>(name, {"integer"}); }
std::optional<std::string> Object::string(const std::string &name) { return find<std::string>(name, {"string"}); }

std::optional<std::string> Object::string_if(const std::string &name) {
    const Property *property = look(name);
    return property && property->node.tag() == "string" ? string(name) : std::nullopt;
}

std::optional<Vec3> Object::point(const std::string &name) { return find<Vec3>(name, {"point", "vector"}); }
std::optional<Vec3> Object::vector(const std::string &name) { return find<Vec3>(name, {"vector", "point"}); }

std::optional<double> Object::number(const std::string &name) {
    const Property *property = ask(name, {"float", "integer"});
    if (!property)
        return std::nullopt;
    const auto *whole = std::get_if<int>(&property->value);
    return whole ? *whole : std::get<double>(property->value);
}

std::optional<Transform> Object::transform(const std::string &name) {
    const Property *property = ask(name, {"transform"});
    return property ? std::optional(*std::get<std::unique_ptr<Transform>>(property->value)) : std::nullopt;
}

std::optional<Color> Object::spectrum_color(SpectrumUse use) {
    std::optional<Color> color;
    if (type_ == "d65") {
        const double scale = number("scale").value_or(1);
        color = this->color("color", SpectrumUse::radiance).value_or(Color{1, 1, 1});
        for (double &c : *color)
            c *= scale;
    } else if (type_ == "uniform") {
        const double value = number("value").value_or(1);
        color = Color{value, value, value};
    } else if (type_ == "srgb") {
        color = this->color("color", SpectrumUse::reflectance);
    } else if (type_ == "blackbody" && use == SpectrumUse::radiance) {
        const std::optional<double> kelvin = number("temperature");
        if (!has("temperature"))
            mistake("<spectrum> lacks its property 'temperature'");
        check(!kelvin || *kelvin > 0, "temperature", "must be greater than 0");
        if (kelvin && *kelvin > 0)
            color = clamped(node_, blackbody(*kelvin), use);
    } else {
        std::vector<std::string> types = {"d65", "srgb", "uniform"};
        if (use == SpectrumUse::radiance)
            types.push_back("blackbody");
        const std::string message = unknown_name("spectrum type", type_, types);
        context().unknown(node_, context().lenient ? message + "; the default is used" : message);
        ignore_all();
    }
    finish();
    return color;
}

std::optional<Color> Object::color(const std::string &name, SpectrumUse use) {
    const Property *written = look(name);
    Object *const *child = written ? std::get_if<Object *>(&written->value) : nullptr;
    if (child && (*child)->tag_ == "texture") {
        add_new(known_properties_, name);
        return std::nullopt;
    }
    if (child && (*child)->tag_ == "spectrum") {
        ask(name);
        return (*child)->spectrum_color(use);
    }
    Property *property = ask(name, {"rgb", "spectrum", "srgb", "float", "integer"});
    if (!property)
        return std::nullopt;
    if (const auto *spectrum = std::get_if<Spectrum>(&property->value)) {
        const Color color = to_rgb(*spectrum, use);
        return spectrum->wavelengths.empty() ? color : clamped(property->node, color, use);
    }
    if (const auto *color = std::get_if<Color>(&property->value)) {
        const bool is_reflectance = std::ranges::all_of(*color, [](double c) { return c >= 0 && c <= 1; });
        if (use != SpectrumUse::reflectance || is_reflectance)
            return *color;
        mistake_at(name,
                   fmt::format("{}, {}, {} is no reflectance, which is 0 to 1", (*color)[0], (*color)[1], (*color)[2]));
        property->value = std::monostate();
        return std::nullopt;
    }
    const auto *whole = std::get_if<int>(&property->value);
    const double grey = whole ? *whole : std::get<double>(property->value);
    return Color{grey, grey, grey};
}

bool Object::has(const std::string &name) const { return look(name) != nullptr; }

std::vector<std::shared_ptr<Object>> Object::children(const std::string &tag) {
    add_new(known_tags_, tag);
    std::vector<std::shared_ptr<Object>> found;
    for (Property &property : properties_)
        if (Object *const *child = std::get_if<Object *>(&property.value); child && (*child)->tag_ == tag) {
            property.asked = true;
            found.push_back(document_->shared(*child));
        }
    return found;
}

std::shared_ptr<Object> Object::child_named(const std::string &name) {
    Property *property = ask(name);
    if (!property || std::holds_alternative<std::monostate>(property->value))
        return nullptr;
    if (Object *const *child = std::get_if<Object *>(&property->value))
        return document_->shared(*child);
    context().mistake(property->node,
                      fmt::format("property '{}' is a <{}> here, but must be an object", name, property->node.tag()));
    property->value = std::monostate();
    return nullptr;
}

std::optional<std::filesystem::path> Object::file(const std::string &name, const std::string &instead) {
    const std::optional<std::string> value = string(name);
    if (!value)
        return std::nullopt;
    const std::optional<std::filesystem::path> found = find_file(*value, document_->folders());
    const std::string message = found ? "" : no_file_text(*value, document_->folders());
    if (!found && context().lenient)
        warn(fmt::format("{}: property '{}': {}; {}", place_of(name).text(), name, message, instead));
    else
        check(found.has_value(), name, message);
    return found;
}

void Object::ignore(const std::string &name) { ask(name); }

void Object::check(bool good, const std::string &name, const std::string &message) const {
    if (!good)
        mistake_at(name, message);
}

void Object::mistake(const std::string &message) const { context().mistake(node_, message); }

void Object::mistake_at(const std::string &name, const std::string &message) const {
    const Property *property = look(name);
    if (property && std::holds_alternative<std::monostate>(property->value))
        return; // that is told
    context().mistake(property ? property->node : node_,
                      name.empty() ? message : fmt::format("property '{}': {}", name, message));
}

SourcePlace Object::place_of(const std::string &name) const {
    const Property *property = look(name);
    return (property ? property->node : node_).place();
}

std::string Object::owner() const {
    return type_.empty() ? fmt::format(" of <{}>", tag_) : fmt::format(" of {} '{}'", tag_, type_);
}

void Object::tell_unfetched(const Property &property) const {
    Object *const *child = std::get_if<Object *>(&property.value);
    const std::string message =
        child && property.name.empty()
            ? fmt::format("no <{}> may stand in <{}>; available: {}", (*child)->tag_, tag_, joined(known_tags_))
            : unknown_name("property", property.name, known_properties_, owner());
    context().unknown(property.node, context().lenient ? message + "; it is left out" : message);
}

void Object::finish() {
    if (is_finished_)
        return;
    is_finished_ = true;
    for (const Property &property : properties_)
        if (!property.asked && !std::holds_alternative<std::monostate>(property.value))
            tell_unfetched(property);
}

void Object::ignore_all() {
    for (Property &property : properties_)
        property.asked = true;
    is_finished_ = true;
}

} // namespace opal::mitsuba
