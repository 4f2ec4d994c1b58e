#include "densities/targets.h"

#include "base/table.h"
#include "base/values.h"
#include "read/nori/load.h"
#include "read/nori/parsers.h"
#include "scene/examples.h"
#include "scene/options.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>

namespace opal {

namespace {

using Parameters = std::map<std::string, std::string>;

#define OPAL_NO_PARAMETER(name, domain) {#name, ""},
#define OPAL_PARAMETER(name, domain, parameter, otherwise) {#name, #parameter},
#define OPAL_NO_DEFAULT(name, domain) {"", 0.f},
#define OPAL_DEFAULT(name, domain, parameter, otherwise) {#parameter, otherwise},
const std::vector<TargetName> warp_names = {OPAL_WARPS(OPAL_NO_PARAMETER, OPAL_NO_PARAMETER, OPAL_PARAMETER)};
const std::pair<const char *, float> warp_defaults[] = {OPAL_WARPS(OPAL_NO_DEFAULT, OPAL_NO_DEFAULT, OPAL_DEFAULT)};

// What the warps sample. A warp without a row here has no help, which a test finds.
const std::map<std::string, std::string> warp_help = {
    {"tent", "points of [-1, 1]^2, density (1 - |x|) (1 - |y|)"},
    {"uniform_disk", "points of the unit disk, density 1 / pi"},
    {"concentric_disk", "the same, by a map that takes squares to rings"},
    {"uniform_sphere", "directions, density 1 / (4 pi)"},
    {"uniform_hemisphere", "directions above the surface, density 1 / (2 pi)"},
    {"cosine_hemisphere", "directions above the surface, density cos(theta) / pi"},
    {"beckmann", "microfacet normals m, density D(m) cos(theta) of roughness alpha"},
    {"phong_lobe", "directions about the axis, density (n + 1) / (2 pi) cos^n"}};

double number_of(const Parameters &parameters, const std::string &name, double otherwise) {
    const auto found = parameters.find(name);
    return found == parameters.end() ? otherwise : parse_number(found->second);
}

// Every parameter given must be one of these.
void allow(const Parameters &parameters, const std::string &target, const std::set<std::string> &known) {
    for (const auto &[name, value] : parameters)
        if (!known.count(name))
            throw Error(fmt::format("{} has no parameter --{}; available: {}", target, name,
                                    known.empty() ? "none" : fmt::format("--{}", fmt::join(known, ", --"))));
}

Target open_warp(int warp, const Parameters &parameters, const Device &device, const BuildOptions &build,
                 const Sources &sources) {
    const auto &[parameter, otherwise] = warp_defaults[warp];
    allow(parameters, warp_name(warp), *parameter ? std::set<std::string>{parameter} : std::set<std::string>{});
    Target target;
    const double value = *parameter ? number_of(parameters, parameter, otherwise) : 0;
    if (*parameter && !(value > 0))
        throw Error(fmt::format("{} needs a positive --{}", warp_name(warp), parameter));
    target.probe = std::make_unique<KernelProbe>(device, scene_of_bsdfs({}), build, sources);
    target.sampled = sampled_warp(*target.probe, warp, float(value));
    target.description = *parameter ? fmt::format("{} {} {:g}", warp_name(warp), parameter, value) : warp_name(warp);
    return target;
}

// Some value, for a parameter that is required.
std::string example_value(ParameterType type) {
    switch (type) {
    case ParameterType::COLOR:
        return "3 2 1";
    case ParameterType::POINT:
        return "0.3 0.6 0.8";
    case ParameterType::VECTOR:
        return "0.2 -0.3 -1";
    default:
        return "1";
    }
}

// Whether the command line can say it.
bool has_text(const Parameter &parameter) {
    return is_property(parameter.type) && parameter.type != ParameterType::TRANSFORM;
}

// An object as a scene would say it, so that defaults and checks are the scene's. BSDFs within it are diffuse.
// `others`: known parameters that are none of its own.
XmlDocument xml_of(const std::string &tag, const std::string &kind, std::span<const Parameter> rows,
                   const Parameters &parameters, const std::string &target, std::set<std::string> others = {}) {
    std::string xml = fmt::format("<{} type=\"{}\">", tag, kind);
    for (const Parameter &row : rows) {
        const std::string name = with_hyphens(row.name);
        if (row.type == ParameterType::BSDF)
            xml += "<bsdf type=\"diffuse\"/>";
        if (!has_text(row))
            continue;
        others.insert(name);
        const auto found = parameters.find(name);
        if (found == parameters.end() && (!std::isnan(row.initial) || row.type == ParameterType::IMAGE))
            continue;
        std::string value = found == parameters.end() ? example_value(row.type) : found->second;
        if (row.type == ParameterType::COLOR && split(value).size() == 1)
            value = fmt::format("{0} {0} {0}", value);
        xml += fmt::format("<{} name=\"{}\" value=\"{}\"/>", xml_tag(row.type), row.xml_name, value);
    }
    allow(parameters, target, others);
    return XmlDocument("command line, as XML", xml + fmt::format("</{}>", tag));
}

Bsdf parse_parameters(uint kind, const Parameters &parameters) {
    const std::string name = bsdf_name(kind);
    const XmlDocument document =
        xml_of("bsdf", name, bsdf_parameters(kind), parameters, "bsdf:" + name, {"theta", "phi"});
    return parse_bsdf(document.root(), {});
}

Target open_bsdf(uint kind, const Parameters &parameters, const Device &device, const BuildOptions &build,
                 const Sources &sources) {
    const Bsdf bsdf = parse_parameters(kind, parameters);
    const double theta = number_of(parameters, "theta", 30) * std::numbers::pi / 180,
                 phi = number_of(parameters, "phi", 0) * std::numbers::pi / 180;
    const Vec3 wi = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    Target target;
    target.probe = std::make_unique<KernelProbe>(device, scene_of_bsdfs({bsdf}), build, sources);
    target.sampled = sampled_bsdf(*target.probe, 0, wi);
    target.description = bsdf_name(kind);
    for (const auto &[name, value] : parameters)
        target.description += fmt::format(" {} {}", name, value);
    if (!parameters.count("theta"))
        target.description += " theta 30";
    return target;
}

Mesh light_of(Shape shape, double radiance) {
    Mesh mesh = examples::light(std::move(shape), radiance);
    mesh.bsdf = Bsdf();
    return mesh;
}

// Part of the unit square of the plane z = 0, between x0 and x1, in six triangles of very different size, one of them a
// sliver.
Mesh light_triangles(double x0, double x1, double radiance) {
    std::vector<Vec3> p = {{x0, 0, 0},    {x1, 0, 0},   {x1, 1, 0}, {x0, 1, 0}, {x0 + (x1 - x0) * 0.7, 0.35, 0},
                           {x1, 0.36, 0}, {x1, 0.37, 0}};
    return light_of(examples::mesh_of(std::move(p), {{0, 1, 4}, {1, 5, 4}, {5, 6, 4}, {6, 2, 4}, {2, 3, 4}, {3, 0, 4}}),
                    radiance);
}

struct LightRow {
    const char *name;
    std::vector<Mesh> (*meshes)();
};
const std::vector<LightRow> lights = {
    {"parallelogram",
     [] {
         return std::vector<Mesh>{light_of(Parallelogram{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 1)};
     }},
    {"mesh", [] { return std::vector<Mesh>{light_triangles(0, 1, 1)}; }},
    {"sphere",
     [] {
         return std::vector<Mesh>{light_of(Sphere{{0.5, 0.5, 0}, 0.4}, 1)};
     }},
    {"sphere_inside",
     [] {
         return std::vector<Mesh>{light_of(Sphere{{0.5, 0.5, 0}, 1, true}, 1)};
     }},
    {"many",
     [] {
         return std::vector<Mesh>{
             light_of(Parallelogram{{0, 0, 0}, {0.25, 0, 0}, {0, 1, 0}}, 1), light_triangles(0.25, 0.75, 2),
             light_of(Parallelogram{{0.75, 0, 0}, {0.25, 0, 0}, {0, 0.5171, 0}}, 5)}; // its end lies between cells
     }},
};

// An emitter of scenes whose directions have a density.
bool is_light_target(uint kind) { return can_be_met(kind) && !emitter_parameters(kind).empty(); }

// The lights named `name`.
SceneDescription scene_of_lights(const std::string &name, const Parameters &parameters) {
    SceneDescription scene;
    for (uint kind = 0; kind < EMITTER_COUNT; kind++)
        if (is_light_target(kind) && name == emitter_name(kind)) {
            scene.lights.push_back(light_of_parameters(kind, parameters));
            return scene;
        }
    allow(parameters, "light:" + name, {});
    scene.meshes = find_row(lights, "light", name).meshes();
    return scene;
}

Target open_light(const std::string &name, const Parameters &parameters, const Parameters &axes, const Device &device,
                  const BuildOptions &build, const Sources &sources) {
    SceneDescription scene = scene_of_lights(name, parameters);
    apply_integrator(scene.strategy, find_integrator("path_mis"));
    override_strategy(scene.strategy, axes);
    Target target;
    target.probe = std::make_unique<KernelProbe>(device, flatten(scene, build.lanes), build, sources);
    target.sampled = sampled_lights(*target.probe);
    target.description = fmt::format("light {}", name);
    for (const Parameters *given : {&parameters, &axes})
        for (const auto &[option, value] : *given)
            target.description += fmt::format(" {} {}", option, value);
    return target;
}

// A BSDF whose directions have a density, or one that leads to others.
bool has_density(uint kind) {
    return (bsdf_traits(kind) & OPAL_SMOOTH) || !std::ranges::all_of(bsdf_parameters(kind), has_text);
}

std::string names_of(std::span<const Parameter> parameters) {
    std::vector<std::string> names;
    for (const Parameter &parameter : parameters)
        if (has_text(parameter))
            names.push_back(with_hyphens(parameter.name));
    return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<TargetName> all_targets() {
    std::vector<TargetName> names = warp_names;
    for (TargetName &warp : names)
        if (const auto help = warp_help.find(warp.name); help != warp_help.end())
            warp.help = help->second;
    for (uint kind = 0; kind < BSDF_COUNT; kind++)
        if (has_density(kind)) {
            const std::string own = names_of(bsdf_parameters(kind));
            names.push_back({fmt::format("bsdf:{}", bsdf_name(kind)), own + (own.empty() ? "" : ", ") + "theta, phi",
                             "reflected directions of the material for an incident direction"});
        }
    for (const LightRow &light : lights)
        names.push_back({"light:" + std::string(light.name), "triangle-choice, emitter-choice",
                         "directions to points of such lights, per solid angle"});
    for (uint kind = 0; kind < EMITTER_COUNT; kind++)
        if (is_light_target(kind))
            names.push_back({fmt::format("light:{}", emitter_name(kind)), names_of(emitter_parameters(kind)),
                             "directions to the light"});
    return names;
}

// Adds to the help of parameter `name` what it means to `owner`.
void add_meaning(std::vector<TargetParameter> &all, const std::string &name, const std::string &owner,
                 const std::string &meaning) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const TargetParameter &p) { return p.name == name; });
    const std::string text = fmt::format("{}: {}", owner, meaning);
    if (found == all.end())
        all.push_back({name, text});
    else
        found->help += "; " + text;
}

std::vector<TargetParameter> all_parameters() {
    std::vector<TargetParameter> all = {{"theta", "bsdf:...: of the incident direction to the normal, degrees [30]"},
                                        {"phi", "bsdf:...: of the incident direction, degrees [0]"}};
    for (int warp = 0; warp < WARP_COUNT; warp++)
        if (const auto &[parameter, otherwise] = warp_defaults[warp]; *parameter)
            add_meaning(all, parameter, warp_name(warp), fmt::format("above 0 [{:g}]", otherwise));
    const auto add_rows = [&](const char *owner, std::span<const Parameter> rows) {
        for (const Parameter &p : rows)
            if (has_text(p))
                add_meaning(all, with_hyphens(p.name), owner,
                            fmt::format("{}, {} [{}]", p.meaning, text_of(p), text_of_initial(p)));
    };
    for (uint kind = 0; kind < BSDF_COUNT; kind++)
        if (has_density(kind))
            add_rows(bsdf_name(kind), bsdf_parameters(kind));
    for (uint kind = 0; kind < EMITTER_COUNT; kind++)
        if (is_light_target(kind))
            add_rows(emitter_name(kind), emitter_parameters(kind));
    return all;
}

} // namespace

Light light_of_parameters(uint kind, const Parameters &parameters) {
    const std::string name = emitter_name(kind);
    const XmlDocument document = xml_of("emitter", name, emitter_parameters(kind), parameters, "light:" + name);
    ParseContext context;
    context.example_map = examples::environment();
    return parse_scene_emitter(document.root(), context);
}

std::string target_name(const std::string &typed) {
    const std::string_view prefix = "square_to_";
    return typed.starts_with(prefix) ? typed.substr(prefix.size()) : typed;
}

const std::vector<TargetName> &targets() {
    static const std::vector<TargetName> all = all_targets();
    return all;
}

const std::vector<TargetParameter> &target_parameters() {
    static const std::vector<TargetParameter> all = all_parameters();
    return all;
}

Target open_target(const std::string &name, const Parameters &parameters, const Parameters &axes, const Device &device,
                   const BuildOptions &build, const Sources &sources) {
    find_row(targets(), "warp", name);
    if (name.starts_with("light:"))
        return open_light(name.substr(6), parameters, axes, device, build, sources);
    if (!axes.empty())
        throw Error(fmt::format("--{} means something for light:... only", axes.begin()->first));
    for (uint kind = 0; kind < BSDF_COUNT; kind++)
        if (name == fmt::format("bsdf:{}", bsdf_name(kind)))
            return open_bsdf(kind, parameters, device, build, sources);
    for (int warp = 0; warp < WARP_COUNT; warp++)
        if (name == warp_name(warp))
            return open_warp(warp, parameters, device, build, sources);
    throw Error("no such warp: " + name); // targets() has no other names
}

} // namespace opal
