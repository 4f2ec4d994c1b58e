// Parsers of emitters. Area lights are children of a mesh, others of the scene: their parameters are those of
// cl/emitters/list.h, by their names in the XML.
#include "read/environment.h"
#include "read/nori/parsers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opal {

namespace {

struct EmitterType {
    std::string name;
    std::optional<EmitterParameters> parameters; // with all defaults; nothing: a child of a mesh
};

const char *const pointlight = "pointlight", *const distantdisk = "distantdisk", *const ibl = "IBL";
constexpr double pi = std::numbers::pi;
constexpr double full_sphere = 4 * pi; // solid angle of all directions

// parallelogram_emitter: the 2022 course's name for the area light of a parallelogram. pointlight: Zaragoza's course,
// which has defaults. spotlight, distantdisk, env, environment, env_map, IBL: public forks of Nori.
#define OPAL_EMITTER_TYPE(name, traits) {#name, emitter_##name{}},
const std::vector<EmitterType> emitter_types = {
    {"area", {}},
    {"parallelogram_emitter", {}},
    OPAL_SCENE_EMITTERS(OPAL_EMITTER_TYPE){
        pointlight, emitter_point{.position = {0, 100, 0}, .power = {full_sphere, full_sphere, full_sphere}}},
    {"spotlight", emitter_spot{}},
    {distantdisk, emitter_constant{}},
    {"env", emitter_envmap{}},
    {"environment", emitter_envmap{}},
    {"env_map", emitter_envmap{}},
    {ibl, emitter_envmap{}}};

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

// A mistake at each of these properties that is given: `other` says it already.
void refuse_beside(const Properties &properties, const std::string &other, std::initializer_list<const char *> names) {
    for (const char *name : names)
        if (properties.has(name))
            properties.mistake_at(name, fmt::format("stands beside '{}', which says it already", other));
}

bool is_negative(const Color &color) { return *std::min_element(color.begin(), color.end()) < 0; }

Color operator*(const Color &color, double factor) { return {color[0] * factor, color[1] * factor, color[2] * factor}; }

// Names of forks of Nori that are more than other names of the list's parameters (names.h). type: that of the file.

// pointlight has `radiance`, which is its intensity in W / sr, for the power over the whole sphere.
void read_names_of_forks(Properties &properties, const std::string &type, emitter_point &light) {
    const auto intensity = type == pointlight ? properties.color("radiance") : std::nullopt;
    if (!intensity)
        return;
    refuse_beside(properties, "radiance", {"power"});
    properties.check(!is_negative(*intensity), "radiance", "must not be negative");
    if (!is_negative(*intensity))
        light.power = *intensity * full_sphere;
}

void read_names_of_forks(Properties &properties, const std::string &type, emitter_constant &) {
    if (type != distantdisk)
        return;
    properties.ignore("toWorld");
    const double half_angle = properties.required(properties.number("thetaA"), "thetaA");
    properties.check(half_angle == 180, "thetaA", "must be 180, a sky of one radiance: Opal has no smaller disk");
}

void read_names_of_forks(Properties &, const std::string &, emitter_directional &) {}
void read_names_of_forks(Properties &, const std::string &, emitter_projector &) {}

// IBL stands upright by default: its z points to the scene's y.
void read_names_of_forks(Properties &, const std::string &type, emitter_envmap &light) {
    if (type == ibl)
        light.to_world.rows = {{{0, -1, 0, 0}, {0, 0, 1, 0}, {-1, 0, 0, 0}, {0, 0, 0, 1}}};
}

// Forks look a direction up by Nori's sphericalCoordinates: rows by the angle from z, columns from x towards y. In the
// frame of an EnvironmentMap these are y, -z and x.
const Transform frame_of_forks{{{{0, 0, -1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}}};

// The angle in degrees of a number that is a cosine in some forks and an angle in degrees in others.
double angle_of(Properties &properties, const std::optional<double> &given, const char *name) {
    const double number = properties.required(given, name);
    if (!(number >= -1 && number <= 180))
        properties.fail_at(name, "must be a cosine, or an angle from 1 to 180 degrees");
    return number <= 1 ? std::acos(number) * (180 / pi) : number;
}

// Forks took their spot from pbrt: it falls by the fourth power, and its intensity is the power over the solid angle of
// the cone whose cosine is the mean of the two.
void read_names_of_forks(Properties &properties, const std::string &, emitter_spot &light) {
    if (const auto cutoff = properties.number("cutoffAngle"))
        light.beam_width = 0.75 * *cutoff; // as in Mitsuba
    const auto power = properties.color("power");
    const auto width = properties.number("cosTotalWidth"), start = properties.number("cosFalloffStart");
    if (!power && !width && !start)
        return;
    light.smooth = true;
    light.cutoff_angle = angle_of(properties, width, "cosTotalWidth");
    light.beam_width = angle_of(properties, start, "cosFalloffStart");
    const Color total = properties.required(power, "power");
    refuse_beside(properties, "power", {"intensity", "cutoffAngle", "beamWidth", "smooth"});
    if (is_negative(total))
        properties.fail_at("power", "must not be negative");
    const double mean_cosine =
        (std::cos(light.cutoff_angle * (pi / 180)) + std::cos(light.beam_width * (pi / 180))) / 2;
    if (!(mean_cosine < 1))
        properties.fail_at("cosTotalWidth", "must be a cosine below 1: the cone is empty");
    light.intensity = total * (1 / (2 * pi * (1 - mean_cosine)));
}

// Whether a parameter that must be given has no value yet.
bool is_unset(const Color &color) { return std::isnan(color[0]); }
bool is_unset(Vec3 v) { return std::isnan(v.x); }
bool is_unset(double number) { return std::isnan(number); }
bool is_unset(bool) { return false; }
bool is_unset(const Transform &) { return false; }
bool is_unset(const std::shared_ptr<const EnvironmentMap> &map) { return !map; }

std::optional<Color> value_of(Properties &properties, const Parameter &parameter, const Color &) {
    return properties.color(parameter.xml_name);
}
std::optional<double> value_of(Properties &properties, const Parameter &parameter, double) {
    return properties.number(parameter.xml_name);
}
std::optional<bool> value_of(Properties &properties, const Parameter &parameter, bool) {
    return properties.boolean(parameter.xml_name);
}
std::optional<Vec3> value_of(Properties &properties, const Parameter &parameter, Vec3) {
    return parameter.type == ParameterType::POINT ? properties.point(parameter.xml_name)
                                                  : properties.vector(parameter.xml_name);
}
std::optional<Transform> value_of(Properties &properties, const Parameter &parameter, const Transform &) {
    return properties.transform(parameter.xml_name);
}
std::optional<std::shared_ptr<const EnvironmentMap>> value_of(Properties &properties, const Parameter &parameter,
                                                              const std::shared_ptr<const EnvironmentMap> &) {
    const ParseContext &context = properties.context();
    const auto name = properties.string(parameter.xml_name);
    if (!name && context.example_map && !properties.has(parameter.xml_name))
        return context.example_map;
    if (!name)
        return std::nullopt;
    const std::filesystem::path file = find_file(properties, parameter.xml_name, *name, "the emitter is left out");
    try {
        return read_environment(file, context.hashes);
    } catch (const Error &error) {
        properties.fail_at(parameter.xml_name, error.what());
    }
}

void check_value(const Properties &properties, const Parameter &parameter, const Color &color) {
    for (double channel : color)
        check_range(properties, parameter, channel);
}
void check_value(const Properties &properties, const Parameter &parameter, double value) {
    check_range(properties, parameter, value);
}
void check_value(const Properties &, const Parameter &, bool) {}
void check_value(const Properties &, const Parameter &, const std::shared_ptr<const EnvironmentMap> &) {}
void check_value(const Properties &properties, const Parameter &parameter, const Transform &value) {
    warn_of_scale(value, properties.place_of(parameter.xml_name));
}
void check_value(const Properties &properties, const Parameter &parameter, Vec3 value) {
    properties.check(parameter.type == ParameterType::POINT || parameter.initial == 0 || length(value) > 0,
                     parameter.xml_name, fmt::format("must not be 0: {}", parameter.meaning));
}

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
    context.attempt(node, [&] {
        std::visit([&](auto &own) { read_names_of_forks(properties, type.name, own); }, light.parameters);
    });
    light.visit([&](const Parameter &parameter, auto &value) {
        context.attempt(node, [&] {
            const auto given = value_of(properties, parameter, value);
            value = is_unset(value) ? properties.required(given, parameter.xml_name) : given.value_or(value);
            check_value(properties, parameter, value);
        });
    });
    properties.finish();
    if (auto *map = std::get_if<emitter_envmap>(&light.parameters)) {
        if (!map->map)
            throw NoObject{};
        map->to_world = map->to_world * frame_of_forks;
    }
    return light;
}

} // namespace opal
