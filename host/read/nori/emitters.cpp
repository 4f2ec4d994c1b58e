// Parsers of emitters. Area lights are children of a mesh, others of the scene: their parameters are those of
// cl/emitters/list.h, by their names in the XML.
#include "read/nori/parsers.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

struct EmitterType {
    std::string name;
    std::optional<EmitterParameters> parameters; // with all defaults; nothing: a child of a mesh
};

// parallelogram_emitter: the 2022 course's name for the area light of a parallelogram.
#define OPAL_EMITTER_TYPE(name, traits) {#name, emitter_##name{}},
const std::vector<EmitterType> emitter_types = {
    {"area", {}}, {"parallelogram_emitter", {}}, OPAL_SCENE_EMITTERS(OPAL_EMITTER_TYPE)};

const EmitterType &type_in(const XmlNode &node, const char *parent) {
    const EmitterType &type = row_of_type(node, emitter_types);
    const std::string wanted = type.parameters ? "scene" : "mesh";
    if (wanted != parent)
        node.fail("emitter '" + type.name + "' must stand in a <" + wanted + ">, not in a <" + parent + ">");
    return type;
}

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
    type_in(node, "mesh");
    Properties properties(node, context);
    const Color color = properties.required(properties.color("radiance"), "radiance");
    properties.check(*std::min_element(color.begin(), color.end()) >= 0, "radiance", "must not be negative");
    mesh.radiance = color;
    mesh.emits_on_both_sides = properties.boolean("twosided").value_or(false);
    properties.finish();
}

Light parse_scene_emitter(const XmlNode &node, const ParseContext &context) {
    Light light{*type_in(node, "scene").parameters, node.place()};
    Properties properties(node, context);
    light.visit([&](const Parameter &parameter, auto &value) {
        const auto given = value_of(properties, parameter, value);
        if (std::isnan(parameter.initial))
            properties.required(given, parameter.xml_name);
        value = given.value_or(value);
        check_value(properties, parameter, value);
    });
    properties.finish();
    return light;
}

} // namespace opal
