#include "base/json.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/units.h"
#include "bench/renders.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "flatten/features.h"
#include "flatten/precision_warnings.h"
#include "flatten/scene_warnings.h"
#include "render/kernel_choice.h"
#include "render/report.h"
#include "scene/filter.h"
#include "scene/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

namespace opal {

namespace {

struct InspectOptions {
    SceneOptions scene;
    bool cl = false, bench = false;
    DeviceOptions device;
    std::string json;
};

// The width that "auto" means for a CPU device here. inspect opens no device, so the host's vectors decide.
int host_vector_width() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx512f") ? 16 : __builtin_cpu_supports("avx2") ? 8 : 4;
#else
    return 4;
#endif
}

template <class... Arguments>
void row(const char *name, fmt::format_string<Arguments...> text, Arguments &&...arguments) {
    print("{:<12}{}\n", name, fmt::format(text, std::forward<Arguments>(arguments)...));
}

std::string color_text(const Color &c) { return fmt::format("{:g} {:g} {:g}", c[0], c[1], c[2]); }

// "3 diffuse, 1 mirror"
std::string counts_text(const std::map<std::string, size_t> &counts) {
    std::vector<std::string> parts;
    for (const auto &[name, count] : counts)
        parts.push_back(fmt::format("{} {}", count, name));
    return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string value_text(const Color &color) { return color_text(color); }
[[maybe_unused]] std::string value_text(double number) { return fmt::format("{:g}", number); }
[[maybe_unused]] std::string value_text(bool flag) { return flag ? "true" : "false"; }
std::string value_text(Vec3 p) { return fmt::format("{:g} {:g} {:g}", p.x, p.y, p.z); }
std::string value_text(const std::shared_ptr<const EnvironmentMap> &map) {
    return fmt::format("of {} x {} pixels", map->width, map->height);
}
std::string value_text(const Transform &t) {
    std::vector<double> numbers;
    for (std::size_t row = 0; row < 3; row++)
        numbers.insert(numbers.end(), t.rows[row].begin(), t.rows[row].begin() + 3);
    return fmt::format("{:.4g}", fmt::join(numbers, " "));
}

// "position 0 1 0, power 10 10 10"
std::string parameters_text(Light light) {
    std::vector<std::string> parts;
    light.visit([&](const Parameter &parameter, const auto &value) {
        parts.push_back(fmt::format("{} {}", parameter.xml_name, value_text(value)));
    });
    return fmt::format("{}", fmt::join(parts, ", "));
}

std::string text_of(const CheckerboardTexture &texture) {
    return fmt::format("a checkerboard of {} and {}", color_text(texture.color0), color_text(texture.color1));
}
std::string text_of(const BitmapTexture &texture) {
    return fmt::format("a bitmap of {} x {} pixels", texture.picture->width, texture.picture->height);
}
std::string text_of(const MeshAttributeTexture &texture) {
    return fmt::format("the mesh's {}{}", texture.name,
                       texture.scale == 1 ? "" : fmt::format(" times {:g}", texture.scale));
}

// " times a bitmap of 64 x 64 pixels"
std::string factor_text(const Texture &texture) {
    return " times " + std::visit([](const auto &own) { return text_of(own); }, texture);
}

// "diffuse, albedo 0.5 0.5 0.5"; a BSDF that leads to others is followed by them: "twosided (mirror)"
std::string bsdf_text(const Bsdf &bsdf) {
    std::string text = bsdf_name(bsdf.kind());
    const auto number = [&](size_t word) { return std::bit_cast<float>(bsdf.words[word]); };
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind())) {
        if (parameter.type == ParameterType::COLOR)
            text += fmt::format(", {} {:g} {:g} {:g}", parameter.xml_name, number(parameter.word),
                                number(parameter.word + 1), number(parameter.word + 2));
        else if (parameter.type == ParameterType::NUMBER)
            text += fmt::format(", {} {:g}", parameter.xml_name, number(parameter.word));
        else if (parameter.type == ParameterType::FLAG && bsdf.words[parameter.word] != 0)
            text += ", " + parameter.xml_name;
        if (const auto found = bsdf.textures.find(parameter.texture_word); found != bsdf.textures.end())
            text += factor_text(found->second);
    }
    std::vector<std::string> children;
    for (const Bsdf &child : bsdf.children)
        children.push_back(bsdf_text(child));
    return children.empty() ? text : fmt::format("{} ({})", text, fmt::join(children, "; "));
}

std::string shape_text(const Mesh &mesh) {
    return std::visit([](const auto &shape) { return shape.text(); }, mesh.shape);
}

// All of a mesh but its name.
std::string mesh_text(const Mesh &mesh) {
    return fmt::format("{}, {}{}", shape_text(mesh), bsdf_text(mesh.bsdf),
                       mesh.radiance ? fmt::format(", emits {} W/(m^2 sr){}{}", color_text(*mesh.radiance),
                                                   mesh.texture ? factor_text(*mesh.texture) : "",
                                                   mesh.emits_on_both_sides ? " on both sides" : "")
                                     : "");
}

constexpr size_t most_meshes = 20; // lines, a screen's worth

// A line for all meshes that differ in their names alone, in the order of the scene.
void print_meshes(const std::vector<Mesh> &meshes) {
    std::vector<std::pair<std::string, size_t>> lines;      // with the first mesh
    std::map<std::string, std::pair<size_t, size_t>> known; // the line, and how often
    for (size_t i = 0; i < meshes.size(); i++) {
        const auto [place, is_new] = known.try_emplace(mesh_text(meshes[i]), lines.size(), 0);
        if (is_new)
            lines.emplace_back(place->first, i);
        place->second.second++;
    }
    for (size_t i = 0; i < std::min(lines.size(), most_meshes); i++) {
        const size_t others = known[lines[i].first].second - 1;
        const std::string &name = meshes[lines[i].second].name;
        row("", "{}{}: {}", name.empty() ? "unnamed" : name, others ? fmt::format(" and {} more", others) : "",
            lines[i].first);
    }
    if (lines.size() > most_meshes)
        row("", "... and {} more kinds of meshes (--json has all)", lines.size() - most_meshes);
}

void print_scene(const SceneDescription &scene, const FlatScene &flat) {
    const Camera &camera = scene.camera;
    row("scene", "{}", scene.file.string());
    row("dialect", "{}", name_of(scene.dialect));
    for (const auto &[name, value] : scene.definitions)
        row("defined", "{} = {}", name, value);
    for (const PluginUse &use : scene.plugins)
        row(&use == &scene.plugins.front() ? "plug-ins" : "", "{} {} '{}': {}", use.count, use.tag, use.type,
            use.becomes);
    row("camera", "{} x {} pixels, {}, near {:g}, far {:g}", camera.width, camera.height, camera_text(camera),
        camera.near_clip, camera.far_clip);
    row("filter", "{}{}", filter_text(camera.filter), camera.filter.given ? "" : " (the dialect's default)");
    row("samples", "{} a pixel", scene.spp);

    std::map<std::string, size_t> bsdfs, emitters;
    for (const Mesh &mesh : scene.meshes)
        ++bsdfs[bsdf_name(mesh.bsdf.kind())];
    for (const EmitterRecord &emitter : flat.emitters)
        ++emitters[emitter_name(emitter.kind)];
    std::set<uint> different;
    for (const MeshRecord &mesh : flat.meshes)
        different.insert(mesh.bsdf);
    row("bsdfs", "{} ({} different)", counts_text(bsdfs), different.size());
    row("emitters", "{}{}", counts_text(emitters), scene.hides_emitters ? ", hidden from the camera" : "");
    for (const Light &light : scene.lights)
        row("", "{}: {}{}", emitter_name(light.kind()), parameters_text(light),
            light.texture ? factor_text(light.texture->texture) : "");
    row("meshes", "{}, {} triangles", scene.meshes.size(), flat.triangles.size());
    print_meshes(scene.meshes);
}

void print_strategy(const SceneDescription &scene, int lanes) {
    const Strategy &strategy = scene.strategy;
    print("\nstrategy, after overrides (the scene's integrator: {})\n", scene.integrator_type);
    print("  {:<18}{}\n", "integrator", axes()[AXIS_integrator].choices[strategy[AXIS_integrator]].name);
    for (const StrategyOption &option : strategy_options())
        if (option.name == "lanes")
            print("  {:<18}{}{}\n", "lanes", lanes,
                  strategy.lanes ? ""
                                 : " (auto: what a CPU device here would take; no device was asked, a GPU takes 1)");
        else
            print("  {:<18}{}\n", option.name, option.text(strategy));
}

void print_buffers(const FlatScene &flat) {
    unsigned long long all = 0;
    print("\nbuffers\n");
    const auto table = [&](const char *name, const auto &rows) {
        const unsigned long long bytes = rows.size() * sizeof(rows[0]);
        all += bytes;
        print("  {:<18}{:>10} rows {:>12}\n", name, rows.size(), bytes_text(bytes));
    };
#define OPAL_PRINT_TABLE(record, name, shown) table(shown, flat.name);
    OPAL_TABLES(OPAL_PRINT_TABLE)
#undef OPAL_PRINT_TABLE
    print("  {:<18}{:>15} {:>12}\n", "in all", "", bytes_text(all));
}

void print_features(const SceneDescription &scene, const Features &features) {
    print("\nfeatures of {}\n", scene.strategy.is_general() ? "the general kernel" : "the scene's kernel");
    if (scene.strategy.specialise == Specialise::automatic && !shares_general_kernel(scene)) {
        print("  (render --specialise auto compiles a kernel for this scene: it has what the general kernel of other "
              "scenes lacks)\n");
    } else if (scene.strategy.specialise == Specialise::automatic) {
        print(
            "  (on a CPU --specialise auto takes the general kernel for fewer than {:.3g} M paths; the scene asks for "
            "{:.3g} M)\n",
            1e-6 * paths_that_pay, 1e-6 * scene.camera.width * scene.camera.height * scene.spp);
    }
    for (unsigned i = 0; i < FEATURE_COUNT; ++i)
        print("  {:<22}{:<5}{}\n", feature_name(i), features[i] ? "in" : "out", features.list[i].reason);
    print("\naxes of the kernel\n");
    for (int axis = 0; axis < AXIS_COUNT; ++axis) {
        const int choice = features.axes[axis];
        print("  {:<22}{} ({})\n", axes()[axis].name, choice < 0 ? "at run time" : axes()[axis].choices[choice].name,
              features.axis_reasons[axis]);
    }
}

// The cost of each feature that the scene does not need, if the kernel had it.
void print_savings(const InspectOptions &options, const SceneDescription &scene) {
    const auto [pick, build] = choose_kernel(options.device, scene);
    const FlatScene flat = flatten(scene, build.lanes);
    const Sources sources = load_sources(options.scene.cl_dir);
    RunningProgress progress("inspect");
    RenderBench bench(open_device(pick.info), flat, build, sources, 0.5, 5);
    print("\nsaved by what is left out ({}, {} lanes; time with it over time without, 5 rounds)\n", pick.info.name,
          build.lanes);
    for (unsigned feature = 0; feature < FEATURE_COUNT; ++feature) {
        if (flat.features[feature])
            continue;
        const std::string name = feature_name(feature);
        if (flat.emitters.empty() && name.starts_with("emitter_")) {
            print("  {:<22}not to be measured: there is no emitter to sample\n", name);
            continue;
        }
        const Race race = bench.race(with_feature(flat, feature), build);
        print("  {:<22}{:.3f} [{:.3f}, {:.3f}] times, and {:.3g} s to compile\n", name, race.time.median,
              race.time.least, race.time.greatest, race.compile_seconds);
    }
}

nlohmann::json json_of(const SceneDescription &scene, const FlatScene &flat, int lanes) {
    const Camera &camera = scene.camera;
    nlohmann::json json = object({{"scene", scene.file.string()},
                                  {"scene_hash", scene.hash},
                                  {"dialect", name_of(scene.dialect)},
                                  {"definitions", scene.definitions},
                                  {"width", camera.width},
                                  {"height", camera.height},
                                  {"camera", camera_text(camera)},
                                  {"near_clip", camera.near_clip},
                                  {"far_clip", camera.far_clip},
                                  {"filter", filter_text(camera.filter)},
                                  {"spp", scene.spp},
                                  {"triangles", flat.triangles.size()},
                                  {"emitters", flat.emitters.size()},
                                  {"hides_emitters", scene.hides_emitters},
                                  {"lanes", lanes},
                                  {"strategy", strategy_json(scene)},
                                  {"plugins", nlohmann::json::array()},
                                  {"lights", nlohmann::json::array()},
                                  {"meshes", nlohmann::json::array()},
                                  {"buffers", nlohmann::json::object()},
                                  {"features", nlohmann::json::array()},
                                  {"notes", scene_notes(scene, false)}});
    for (const PluginUse &use : scene.plugins)
        json["plugins"].push_back(
            object({{"tag", use.tag}, {"type", use.type}, {"becomes", use.becomes}, {"count", use.count}}));
    for (const Light &light : scene.lights)
        json["lights"].push_back(
            object({{"type", emitter_name(light.kind())}, {"parameters", parameters_text(light)}}));
    for (const Mesh &mesh : scene.meshes)
        json["meshes"].push_back(object({{"name", mesh.name},
                                         {"shape", shape_text(mesh)},
                                         {"bsdf", bsdf_text(mesh.bsdf)},
                                         {"radiance", mesh.radiance ? nlohmann::json(*mesh.radiance) : nullptr},
                                         {"twosided", mesh.emits_on_both_sides}}));
#define OPAL_BUFFER(record, name, shown)                                                                               \
    json["buffers"][shown] = object({{"rows", flat.name.size()}, {"bytes", flat.name.size() * sizeof(flat.name[0])}});
    OPAL_TABLES(OPAL_BUFFER)
#undef OPAL_BUFFER
    for (unsigned i = 0; i < FEATURE_COUNT; ++i)
        json["features"].push_back(object(
            {{"name", feature_name(i)}, {"in", bool(flat.features[i])}, {"reason", flat.features.list[i].reason}}));
    return json;
}

int run_inspect(const InspectOptions &options) {
    const SceneDescription scene = load_scene(options.scene);
    prepare_json(options.json);
    const int lanes = scene.strategy.lanes ? scene.strategy.lanes : host_vector_width();
    const FlatScene flat = flatten(scene, lanes);
    if (options.cl) {
        BuildOptions build;
        build.lanes = lanes;
        build.math = scene.strategy.math;
        print_text(program_text(flat.features, build, load_sources(options.scene.cl_dir)));
        return 0;
    }
    print_scene(scene, flat);
    print_strategy(scene, lanes);
    print_buffers(flat);
    print_features(scene, flat.features);
    for (const std::string &line : scene_warnings(scene))
        warn(line);
    for (const std::string &line : precision_warnings(scene, flat))
        warn(line);
    for (const std::string &line : scene_notes(scene, false))
        note(line);
    write_json(options.json, "inspect", json_of(scene, flat, lanes));
    if (options.bench)
        print_savings(options, scene);
    return 0;
}

} // namespace

Command inspect_command() {
    auto o = std::make_shared<InspectOptions>();
    return {.name = "inspect",
            .help = "Show what a scene holds, and what its kernel will be compiled with and why",
            .options =
                append(scene_rows(o->scene),
                       {{.flags = "--cl", .target = &o->cl, .help = "Print the text of the kernel's program instead"},
                        json_row(o->json, "all of this, with every mesh"),
                        {.flags = "--bench",
                         .target = &o->bench,
                         .help = "Render with each feature that is left out, and without: what it saved"},
                        device_row(o->device),
                        threads_row(o->device)}),
            .examples = {"opal inspect scenes/mixed_room.xml", "opal inspect scenes/cbox_mis.xml --cl --lanes 1"},
            .run = [o] { return run_inspect(*o); }};
}

} // namespace opal
