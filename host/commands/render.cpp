// opal render: a scene to an EXR and a PNG.
#include "base/command_line.h"
#include "base/error.h"
#include "base/json.h"
#include "base/log.h"
#include "base/signals.h"
#include "base/units.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "flatten/flat_scene.h"
#include "flatten/scene_warnings.h"
#include "render/render_film.h"
#include "render/report.h"
#include "scene/options.h"
#include "selftest/selftest.h"
#include "strategies/combinations.h"
#include "sweep/auto.h"

#include <fmt/format.h>

namespace opal {

namespace {

struct Options {
    SceneOptions scene;
    DeviceOptions device;
    std::string out, json, layers, time, time_limit, target_error, strategy;
    unsigned spp = 0, width = 0, height = 0; // 0: the scene's
    unsigned seed = 0;
    bool no_png = false, quiet = false, verbose = false;
};

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void tell_what_runs(const SceneDescription &scene, const FlatScene &flat, const DevicePick &pick, int lanes,
                    unsigned seed) {
    std::string strategy;
    for (int axis : acting_axes(scene))
        strategy += fmt::format("{}{} {}", axis ? ", " : "", axes()[axis].name,
                                axis == AXIS_integrator ? integrator_name(scene)
                                                        : axes()[axis].choices[scene.strategy[axis]].name);
    const auto count = [](size_t n, const char *what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); };
    info(fmt::format("scene   {}: {}, {}, {}, {} x {} pixels, {} spp, seed {}", scene.file.string(),
                     scene.meshes.size() == 1 ? "1 mesh" : fmt::format("{} meshes", scene.meshes.size()),
                     count(flat.triangles.size(), "triangle"), count(flat.emitters.size(), "emitter"),
                     scene.camera.width, scene.camera.height, scene.spp, seed));
    info("how     " + strategy);
    info(fmt::format("device  {}, {} lane{}, math {}", text_of(pick), lanes, lanes == 1 ? "" : "s",
                     name_of(scene.strategy.math)));
}

StopRule stop_rule(const Options &o) {
    StopRule rule;
    if (!o.time.empty())
        rule.seconds = parse_seconds(o.time);
    if (!o.time_limit.empty())
        rule.wall_seconds = parse_seconds(o.time_limit);
    if (!o.target_error.empty())
        rule.relative_error = parse_fraction(o.target_error);
    return rule;
}

// Warns if the driver's relaxed functions are too coarse: some keep 11 bits. They are measured, because no list knows
// the next driver. The kernel is the same for all scenes, so that most drivers have it in their cache.
void warn_of_fast_functions(const Device &device, const BuildOptions &build, const Sources &sources) {
    std::vector<std::string> wrong;
    for (const Finding &f : check_functions(device, build, sources))
        if (!f.passed)
            wrong.push_back(fmt::format("{} {:.3g} (at most {:g} is harmless)", f.check, f.figure, f.limit));
    if (!wrong.empty())
        warn(fmt::format("--math fast: {} (driver {}) computes functions too coarsely, and the image shows it: {}; "
                         "take --math precise",
                         device.info.name, device.info.driver, fmt::join(wrong, "; ")));
}

// The request of a render, checked before a device is opened.
struct Request {
    SceneDescription scene;
    StopRule rule;
    unsigned spp;                   // 0: the rule alone decides
    std::filesystem::path exr, png; // empty: not written
    std::string json;               // for write_json
    double load_seconds;
};

Request prepare(const Options &o) {
    Request request;
    request.rule = stop_rule(o);
    const Stopwatch load;
    SceneDescription &scene = request.scene = load_scene(o.scene);
    set_size(scene.camera, o.width, o.height);
    if (o.spp)
        scene.spp = o.spp;
    request.spp = request.rule.given() && !o.spp ? 0 : scene.spp;
    request.exr = o.out.empty() ? scene.file.stem().replace_extension(".exr") : std::filesystem::path(o.out);
    request.json = o.json;
    prepare_json(o.json);
    const std::filesystem::path png = std::filesystem::path(request.exr).replace_extension(".png");
    if (png == request.exr)
        throw Error(fmt::format("--output {}: names the EXR file; the PNG goes beside it", request.exr.string()));
    const bool beside_device = std::filesystem::exists(request.exr) && !std::filesystem::is_regular_file(request.exr);
    if (!o.no_png && !beside_device) // none beside /dev/null
        request.png = png;
    for (const std::filesystem::path &file : {request.exr, request.png})
        if (!file.empty())
            check_writable(file);
    request.load_seconds = load.seconds();
    constexpr size_t most_faces = 300'000; // 0.03 s; `opal inspect` looks at all
    for (const std::string &line : scene_warnings(scene, most_faces))
        warn(line);
    for (const std::string &line : scene_notes(scene, o.spp || request.rule.given()))
        note(line);
    return request;
}

// Writes the image with the report in its header, and tells the result. Returns the exit code.
int report(const Request &request, const RenderedFilm &rendered, const RenderReport &render,
           const std::optional<AutoChoice> &choice, bool variance) {
    for (const std::string &line : film_warnings(render))
        warn(line);
    Image image = image_of(rendered.film, variance);
    nlohmann::json json = render.json();
    const StopReport stop = report_stop(request.rule, rendered.stopped, render);
    if (choice)
        json["auto"] = choice->json();
    if (request.rule.given())
        json["stop"] = stop.json();
    json["interrupted"] = !rendered.stopped.complete;
    if (request.spp > 0 || !rendered.stopped.complete) // else the rule alone decides
        json["asked_spp"] = rendered.stopped.spp;
    add_metadata(image, json, command_line());
    const Stopwatch write;
    write_exr(image, request.exr);
    if (!request.png.empty())
        write_png(image, request.png);
    json["seconds"]["write"] = write.seconds();
    write_json(request.json, "render", json);

    info(render.text());
    if (request.rule.given()) {
        info(stop.text());
        if (!stop.met)
            warn(stop.warning());
    }
    info(fmt::format("wrote   {}{}", request.exr.string(), request.png.empty() ? "" : " and " + request.png.string()));
    if (rendered.stopped.complete)
        return 0;
    warn(fmt::format("interrupted: the image holds {:.4g} of {} samples a pixel", render.spp(), rendered.stopped.spp));
    return interrupt_exit_code();
}

int run(const Options &o) {
    set_quiet(o.quiet);
    set_verbose(o.verbose);
    Request request = prepare(o);
    SceneDescription &scene = request.scene;
    const auto [pick, build] = choose_kernel(o.device, scene);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene.cl_dir);
    std::optional<AutoChoice> choice;
    if (!o.strategy.empty()) {
        choice = choose_strategy(scene, device, sources, o.seed);
        info(choice->text());
        scene.strategy = choice->strategy;
    }
    const Stopwatch bvh;
    const FlatScene flat = flatten(scene, build.lanes);
    const double bvh_seconds = bvh.seconds();
    tell_what_runs(scene, flat, pick, build.lanes, o.seed);
    if (build.math == MathMode::fast)
        warn_of_fast_functions(device, build, sources);
    const RenderedFilm rendered =
        render_film(device, flat, {.build = build, .sources = &sources}, request.rule, o.seed, request.spp);
    const RenderSeconds seconds = {.load = request.load_seconds,
                                   .bvh = bvh_seconds,
                                   .compile = rendered.compile_seconds,
                                   .render = rendered.kernel_seconds};
    return report(request, rendered, {scene, rendered.film, pick.info, build.lanes, o.seed, seconds}, choice,
                  o.layers == "variance");
}

} // namespace

Command render_command() {
    auto o = std::make_shared<Options>();
    return {.name = "render",
            .help = "Render a scene to an EXR and a PNG",
            .options = append(
                scene_rows(o->scene),
                {device_row(o->device),
                 threads_row(o->device),
                 {.flags = "-o,--output",
                  .target = &o->out,
                  .help = "EXR file; the PNG goes beside it [the scene's name, in the current folder]",
                  .type = "FILE"},
                 {.flags = "--no-png", .target = &o->no_png, .help = "Write no PNG"},
                 {.flags = "--spp",
                  .target = &o->spp,
                  .help = "Samples per pixel [the scene's sampleCount]",
                  .check = Range{1u, 0xffffffffu}},
                 {.flags = "--time",
                  .target = &o->time,
                  .help = "Stop after this much kernel time (30s, 2min); --spp is then the most",
                  .check = Accepts{parse_seconds},
                  .type = "TIME"},
                 {.flags = "--target-error",
                  .target = &o->target_error,
                  .help = "Stop when the relative standard error of the image's mean luminance is below this (1%)\n"
                          "  A pilot of other samples decides how many, so that the image stays unbiased",
                  .check = Accepts{parse_fraction},
                  .type = "ERROR",
                  .excludes = "--time"},
                 {.flags = "--time-limit",
                  .target = &o->time_limit,
                  .help = "Stop rendering this long after the start of the process, by the wall clock: loading and "
                          "compiling count, writing comes after; --spp is then the most",
                  .check = Accepts{parse_seconds},
                  .type = "TIME",
                  .excludes = "--target-error"},
                 {.flags = "--strategy",
                  .target = &o->strategy,
                  .help = "auto: short pilots find which way to sample light costs least on this scene and device",
                  .check = OneOf<std::string>{{"auto"}}},
                 {.flags = "--width",
                  .target = &o->width,
                  .help = "Pixels; one of both keeps the aspect [the scene's]",
                  .check = Range{1, 65535}},
                 {.flags = "--height", .target = &o->height, .help = "Pixels [the scene's]", .check = Range{1, 65535}},
                 {.flags = "--seed",
                  .target = &o->seed,
                  .help = "Of the random numbers; the same seed gives the same image"},
                 json_row(o->json, "the statistics of the render"),
                 {.flags = "--layers",
                  .target = &o->layers,
                  .help = "More layers for the EXR: variance (of each pixel's mean)",
                  .check = OneOf<std::string>{{"variance"}}},
                 {.flags = "--quiet", .target = &o->quiet, .help = "Print nothing but warnings and errors"},
                 {.flags = "--verbose",
                  .target = &o->verbose,
                  .help = "Print what the driver remarks on the kernels, too",
                  .excludes = "--quiet"}}),
            .examples = {"opal render scenes/cbox_mis.xml --spp 64 -o box.exr",
                         "opal scenes/mixed_room.xml --time 30s --width 400"},
            .run = [o] { return run(*o); }};
}

} // namespace opal
