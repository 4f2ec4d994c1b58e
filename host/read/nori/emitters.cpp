// Parsers of emitters. Area lights are children of a mesh, others of the scene: their parameters are those of
// cl/emitters/list.h, by their names in the XML.
#include "read/nori/parsers.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace opal {

namespace {

struct EmitterType {
    std::string name;
    std::optional<EmitterParameters> parameters; // with all defaults; nothing: a child of a mesh
};

const char *const pointlight = "pointlight";
constexpr double full_sphere = 4 * std::numbers::pi; // solid angle of all directions

// parallelogram_emitter: the 2022 course's name for the area light of a parallelogram. pointlight: Zaragoza's course,
// which has defaults.
#define OPAL_EMITTER_TYPE(name, traits) {#name, emitter_##name{}},
const std::vector<EmitterType> emitter_types = {
    {"area", {}},
    {"parallelogram_emitter", {}},
    OPAL_SCENE_EMITTERS(OPAL_EMITTER_TYPE){
        pointlight, emitter_point{.position = {0, 100, 0}, .power = {full_sphere, full_sphere, full_sphere}}}};

// The type of an emitter in a <parent>. Throws NoObject if there is none, or if it stands in the wrong place.
const EmitterType &type_in(Properties &properties, const char *parent) {
    const EmitterType *type = properties.row_of_type(emitter_types, "it is left out");
    if (!type)
        throw NoObject{};
    const std::string wanted = type->parameters ? "scene" : "mesh";
    if (wanted != parent) {
        properties.context().unknown(
            properties.object(), fmt::format("emitter '{}' must stand in a <{}>, not in a <{}>{}", type->name, wanted,
                                             parent, properties.context().lenient ? "; it is left out" : ""));
        throw NoObject{};
    }
    return *type;
}

// pointlight has `radiance`, which is its intensity in W / sr, for the power over the whole sphere.
void read_intensity(Properties &properties, emitter_point &light) {
    const std::optional<Color> intensity = properties.color("radiance");
    if (!intensity)
        return;
    if (properties.color("power"))
        properties.mistake_at("power", "stands beside 'radiance', which says it already");
    const bool is_good = *std::min_element(intensity->begin(), intensity->end()) >= 0;
    properties.check(is_good, "radiance", "must not be negative");
    for (size_t i = 0; is_good && i < intensity->size(); i++)
        light.power[i] = full_sphere * (*intensity)[i];
}

// Whether a parameter that must be given has no value yet.
bool is_unset(const Color &color) { return std::isnan(color[0]); }
bool is_unset(Vec3 v) { return std::isnan(v.x); }
[[maybe_unused]] bool is_unset(double number) { return std::isnan(number); }
[[maybe_unused]] bool is_unset(bool) { return false; }

std::optional<Color> value_of(Properties &properties, const Parameter &parameter, const Color &) {
    return properties.color(parameter.xml_name);
}
[[maybe_unused]] std::optional<double> value_of(Properties &properties, const Parameter &parameter, double) {
    return properties.number(parameter.xml_name);
}
[[maybe_unused]] std::optional<bool> value_of(Properties &properties, const Parameter &parameter, bool) {
    return properties.boolean(parameter.xml_name);
}
std::optional<Vec3> value_of(Properties &properties, const Parameter &parameter, Vec3) {
    return parameter.type == ParameterType::POINT ? properties.point(parameter.xml_name)
                                                  : properties.vector(parameter.xml_name);
}

void check_value(const Properties &properties, const Parameter &parameter, const Color &color) {
    for (double channel : color)
        check_range(properties, parameter, channel);
}
[[maybe_unused]] void check_value(const Properties &properties, const Parameter &parameter, double value) {
    check_range(properties, parameter, value);
}
[[maybe_unused]] void check_value(const Properties &, const Parameter &, bool) {}
void check_value(const Properties &, const Parameter &, Vec3) {}

} // namespace

void check_range(const Properties &properties, const Parameter &parameter, double value) {
    properties.check(parameter.range.holds(static_cast<float>(value)), parameter.xml_name,
                     fmt::format("must be {}: {}", text_of(parameter), parameter.meaning));
}

void parse_area_emitter(const XmlNode &node, const ParseContext &context, Mesh &mesh) {
    Properties properties(node, context);
    type_in(properties, "mesh");
    Color color{};
    context.attempt(node, [&] { color = properties.required(properties.color("radiance"), "radiance"); });
    properties.check(*std::min_element(color.begin(), color.end()) >= 0, "radiance", "must not be negative");
    mesh.radiance = color;
    mesh.emits_on_both_sides = properties.boolean("twosided").value_or(false);
    properties.finish();
}

Light parse_scene_emitter(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context);
    const EmitterType &type = type_in(properties, "scene");
    Light light{*type.parameters, node.place()};
    if (type.name == pointlight)
        read_intensity(properties, std::get<emitter_point>(light.parameters));
    light.visit([&](const Parameter &parameter, auto &value) {
        context.attempt(node, [&] {
            const auto given = value_of(properties, parameter, value);
            value = is_unset(value) ? properties.required(given, parameter.xml_name) : given.value_or(value);
            check_value(properties, parameter, value);
        });
    });
    properties.finish();
    return light;
}

} // namespace opal
