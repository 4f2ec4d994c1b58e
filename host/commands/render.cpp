// opal render: a scene to an EXR and a PNG.
#include "base/command_line.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/signals.h"
#include "commands/commands.h"
#include "commands/options.h"
#include "flatten/flat_scene.h"
#include "render/renderer.h"
#include "render/report.h"

#include <fmt/format.h>

namespace opal {

namespace {

struct Options {
    SceneOptions scene;
    std::string device, out, json, layers;
    unsigned spp = 0, width = 0, height = 0, seed = 0;
    bool no_png = false, quiet = false;
};

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void apply_size(SceneDescription &scene, const Options &o, const CLI::App &app) {
    if (app.count("--width") + app.count("--height") == 1) // the scene's aspect
        (app.count("--width") ? scene.camera.height : scene.camera.width) =
            app.count("--width") ? std::max(1, int(std::lround(double(o.width) * scene.camera.height / scene.camera.width)))
                                 : std::max(1, int(std::lround(double(o.height) * scene.camera.width / scene.camera.height)));
    if (app.count("--width"))
        scene.camera.width = int(o.width);
    if (app.count("--height"))
        scene.camera.height = int(o.height);
    if (app.count("--spp"))
        scene.spp = o.spp;
}

void tell_what_runs(const SceneDescription &scene, const FlatScene &flat, const DevicePick &pick, int lanes, unsigned seed) {
    std::string strategy;
    for (int axis = 0; axis < AXIS_COUNT; axis++)
        strategy += fmt::format("{}{} {}", axis ? ", " : "", axes()[axis].name,
                                axis == AXIS_integrator ? scene.integrator_type : axes()[axis].choices[scene.strategy[axis]].name);
    info(fmt::format("scene   {}: {} meshes, {} triangles, {} emitters, {} x {} pixels, {} spp, seed {}", scene.file.string(),
                     scene.meshes.size(), flat.triangles.size(), flat.emitters.size(), scene.camera.width, scene.camera.height,
                     scene.spp, seed));
    info("how     " + strategy);
    info(fmt::format("device  {} (driver {}; {}), {} lane{}, math {}", pick.info.name, pick.info.driver, pick.reason, lanes,
                     lanes == 1 ? "" : "s", scene.strategy.math == MathMode::fast ? "fast" : "precise"));
}

void tell_result(const nlohmann::json &report, const Film &film) {
    info(fmt::format("result  mean luminance {:.6g} +- {:.2g}, {:.4g} M paths/s over {:.3g} s of kernel time",
                     report["mean_luminance"].get<double>(), report["stderr_luminance"].get<double>(),
                     1e-6 * report["samples_per_second"].get<double>(), report["seconds"]["render"].get<double>()));
    if (film.invalid == 0)
        return;
    std::string places;
    for (const InvalidSample &p : film.invalid_places)
        places += fmt::format(" pixel ({}, {}) sample {};", p.x, p.y, p.sample);
    warn(fmt::format("{} samples were NaN or infinite and are left out of the image; the first:{}", film.invalid, places));
}

int run(const Options &o, const CLI::App &app) {
    set_quiet(o.quiet);
    const bool variance = o.layers == "variance";
    RenderSeconds seconds;

    Stopwatch load;
    SceneDescription scene = load_scene(o.scene);
    apply_size(scene, o, app);
    const std::filesystem::path exr = o.out.empty() ? scene.file.stem().replace_extension(".exr") : std::filesystem::path(o.out);
    const std::filesystem::path png = std::filesystem::path(exr).replace_extension(".png");
    if (png == exr)
        throw Error(fmt::format("--output {}: names the EXR file; the PNG goes beside it", exr.string()));
    check_writable(exr);
    if (!o.no_png)
        check_writable(png);
    if (!o.json.empty())
        check_writable(o.json);
    seconds.load = load.seconds();

    const DevicePick pick = pick_device(o.device, list_devices());
    const int lanes = scene.strategy.lanes ? scene.strategy.lanes : pick.info.native_lanes;
    Stopwatch bvh;
    const FlatScene flat = flatten(scene, lanes);
    seconds.bvh = bvh.seconds();
    tell_what_runs(scene, flat, pick, lanes, o.seed);

    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene);
    RenderOptions options;
    options.build = {.lanes = lanes, .double_precision = false, .math = scene.strategy.math, .kernels = "kernels/render.cl"};
    options.sources = &sources;
    Renderer renderer(device, flat, options);
    renderer.restart(o.seed);
    seconds.compile = renderer.compile_seconds();

    watch_interrupts();
    const double pixels = double(scene.camera.width) * scene.camera.height;
    bool complete;
    {
        Progress progress("render", scene.spp * pixels);
        complete = renderer.render(scene.spp, [&](double samples, double) {
            progress.update(samples * pixels);
            return !interrupted();
        });
    }
    seconds.render = renderer.kernel_seconds();

    const Film film = renderer.film();
    Image image = image_of(film, variance);
    add_metadata(image, report_json(scene, pick.info, lanes, o.seed, film, seconds), command_line());
    Stopwatch write;
    write_exr(image, exr);
    if (!o.no_png)
        write_png(image, png);
    seconds.write = write.seconds();

    const nlohmann::json report = report_json(scene, pick.info, lanes, o.seed, film, seconds);
    if (!o.json.empty())
        write_safely(o.json, report.dump(2) + "\n");
    tell_result(report, film);
    info(fmt::format("wrote   {}{}", exr.string(), o.no_png ? "" : " and " + png.string()));
    if (complete)
        return 0;
    warn(fmt::format("interrupted: the image holds {:.4g} of {} samples a pixel", report["spp"].get<double>(), scene.spp));
    return exit_interrupted;
}

} // namespace

RunCommand setup_render(CLI::App &app) {
    auto o = std::make_shared<Options>();
    add_scene_options(app, o->scene);
    add_device_option(app, o->device);
    app.add_option("-o,--output", o->out, "EXR file; the PNG goes beside it (default: the scene's name, in the current folder)");
    app.add_flag("--no-png", o->no_png, "Write no PNG");
    app.add_option("--spp", o->spp, "Samples per pixel (default: the scene's sampleCount)")->check(CLI::Range(1u, 0xffffffffu));
    app.add_option("--width", o->width, "Pixels (default: the scene's; one of both keeps its aspect)")->check(CLI::Range(1, 65535));
    app.add_option("--height", o->height, "Pixels (default: the scene's)")->check(CLI::Range(1, 65535));
    app.add_option("--seed", o->seed, "Of the random numbers; the same seed gives the same image")->capture_default_str();
    app.add_option("--json", o->json, "File for the statistics of the render");
    app.add_option("--layers", o->layers, "More layers for the EXR: variance (of each pixel's mean)")->check(CLI::IsMember({"variance"}));
    app.add_flag("--quiet", o->quiet, "Print nothing but warnings and errors");
    return [o, &app] { return run(*o, app); };
}

} // namespace opal
