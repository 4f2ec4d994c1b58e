// opal render: a scene to an EXR and a PNG.
#include "base/command_line.h"
#include "base/json.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/signals.h"
#include "base/units.h"
#include "commands/commands.h"
#include "commands/options.h"
#include "flatten/flat_scene.h"
#include "render/renderer.h"
#include "render/report.h"
#include "render/stop_rules.h"
#include "selftest/selftest.h"
#include "stats/special.h"
#include "sweep/measure.h"

#include <fmt/format.h>

namespace opal {

namespace {

constexpr unsigned most_samples = 1u << 31; // where a stop rule alone decides

struct Options {
    SceneOptions scene;
    std::string device, out, json, layers, time, target_error, strategy;
    unsigned spp = 0, width = 0, height = 0, seed = 0;
    bool no_png = false, quiet = false, verbose = false;
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
            app.count("--width")
                ? std::max(1, int(std::lround(double(o.width) * scene.camera.height / scene.camera.width)))
                : std::max(1, int(std::lround(double(o.height) * scene.camera.width / scene.camera.height)));
    if (app.count("--width"))
        scene.camera.width = int(o.width);
    if (app.count("--height"))
        scene.camera.height = int(o.height);
    if (app.count("--spp"))
        scene.spp = o.spp;
}

void tell_what_runs(const SceneDescription &scene, const FlatScene &flat, const DevicePick &pick, int lanes,
                    unsigned seed) {
    std::string strategy;
    for (int axis = 0; axis < AXIS_COUNT; axis++)
        strategy += fmt::format("{}{} {}", axis ? ", " : "", axes()[axis].name,
                                axis == AXIS_integrator ? scene.integrator_type
                                                        : axes()[axis].choices[scene.strategy[axis]].name);
    info(fmt::format("scene   {}: {} meshes, {} triangles, {} emitters, {} x {} pixels, {} spp, seed {}",
                     scene.file.string(), scene.meshes.size(), flat.triangles.size(), flat.emitters.size(),
                     scene.camera.width, scene.camera.height, scene.spp, seed));
    info("how     " + strategy);
    info(fmt::format("device  {} (driver {}; {}), {} lane{}, math {}", pick.info.name, pick.info.driver, pick.reason,
                     lanes, lanes == 1 ? "" : "s", name_of(scene.strategy.math)));
}

constexpr double confidence = 0.95;

StopRule stop_rule(const Options &o) {
    StopRule rule;
    if (!o.time.empty())
        rule.seconds = parse_seconds(o.time);
    if (!o.target_error.empty())
        rule.relative_error = parse_fraction(o.target_error);
    return rule;
}

// What was asked for and what was reached; the interval holds the true mean luminance with that confidence. Errors and
// interval are null where pixels have no sample: what those would add to the mean is unknown.
nlohmann::json stop_json(const StopRule &rule, const StopResult &stopped, const Film &film, double seconds) {
    const FilmStatistics s = statistics_of(film);
    const double half = stats::normal_quantile(0.5 + confidence / 2) * s.stderr_luminance;
    const double reached = s.empty_pixels ? INFINITY : s.mean_luminance > 0 ? s.stderr_luminance / s.mean_luminance : 0;
    nlohmann::json j = {{"rule", rule.seconds > 0 ? "time" : "target-error"},
                        {"target", rule.seconds > 0 ? rule.seconds : rule.relative_error},
                        {"reached", rule.seconds > 0 ? seconds : reached},
                        {"relative_error", reached},
                        {"confidence", confidence},
                        {"mean_luminance_interval", nullptr}};
    if (s.empty_pixels == 0)
        j["mean_luminance_interval"] = {s.mean_luminance - half, s.mean_luminance + half};
    if (rule.relative_error > 0)
        j.update({{"met", s.mean_luminance > 0 && reached <= rule.relative_error},
                  {"pilot_spp", stopped.pilot_spp},
                  {"pilot_seconds", stopped.pilot_seconds}});
    return j;
}

void tell_stop(const nlohmann::json &stop, double spp, double seconds) {
    std::string words = fmt::format("stopped after {:.4g} samples a pixel and {:.4g} s of kernel time: ", spp, seconds);
    const nlohmann::json &interval = stop["mean_luminance_interval"];
    if (interval.is_null())
        words += "the mean luminance of the whole image is unknown";
    else
        words += fmt::format("relative standard error {:.3g} % of the mean luminance, which is in [{:.6g}, {:.6g}] "
                             "with confidence {:g} %",
                             100 * stop["relative_error"].get<double>(), interval[0].get<double>(),
                             interval[1].get<double>(), 100 * confidence);
    if (stop.contains("pilot_spp"))
        words += fmt::format("; a pilot of {} samples a pixel ({:.3g} s) decided and is not in the image",
                             stop["pilot_spp"].get<unsigned>(), stop["pilot_seconds"].get<double>());
    info("error   " + words);
    if (!stop.value("met", true))
        warn(interval.is_null() ? fmt::format("--target-error {:g} %: not reached", 100 * stop["target"].get<double>())
                                : fmt::format("--target-error {:g} %: reached {:.3g} %",
                                              100 * stop["target"].get<double>(), 100 * stop["reached"].get<double>()));
}

void tell_result(const nlohmann::json &report) {
    const nlohmann::json &error = report["stderr_luminance"];
    const std::string of =
        error.is_null() ? "of the pixels that have samples" : fmt::format("+- {:.2g}", error.get<double>());
    info(fmt::format("result  mean luminance {:.6g} {}, {:.4g} M paths/s over {:.3g} s of kernel time",
                     report["mean_luminance"].get<double>(), of, 1e-6 * report["samples_per_second"].get<double>(),
                     report["seconds"]["render"].get<double>()));
}

// What the image lacks. Called before the report is made, which lists the warnings. seconds: the film's kernel time.
void warn_of_gaps(const Film &film, double seconds) {
    if (film.invalid) {
        std::string places;
        for (const InvalidSample &p : film.invalid_places)
            places += fmt::format(" pixel ({}, {}) sample {};", p.x, p.y, p.sample);
        warn(fmt::format("{} samples were NaN or infinite and are left out of the image; the first:{}", film.invalid,
                         places));
    }
    const FilmStatistics s = statistics_of(film);
    if (s.empty_pixels == 0)
        return;
    const size_t pixels = film.count.size();
    std::string words = fmt::format(
        "{} of {} pixels ({:.3g} %) have no {}sample: the image shows nothing there, and its mean is that "
        "of the others, with unknown error",
        s.empty_pixels, pixels, 100 * double(s.empty_pixels) / double(pixels), film.invalid ? "valid " : "");
    if (!film.invalid)
        words += fmt::format("; one sample of every pixel takes about {:.2g} s",
                             seconds * double(pixels) / double(s.samples));
    warn(words);
}

// --strategy auto: sets the strategy of the sweep's preset `course` that costs least by short pilots, and says why.
// Their samples have indices of their own and are in no image.
nlohmann::json choose_strategy(SceneDescription &scene, const Device &device, const Sources &sources, unsigned seed) {
    constexpr double pilot_seconds = 0.25;
    const std::vector<Candidate> candidates = parse_strategies(scene, {"course"}, {});
    std::vector<Pilot> pilots;
    for (const Candidate &c : candidates) {
        CompiledStrategy strategy(device, c, sources, device.info.type == "cpu" ? Clock::cpu : Clock::kernel);
        pilots.push_back(run_pilot(strategy, seed, pilot_seconds));
    }
    const std::vector<double> costs = pilot_costs(pilots);
    const size_t best = size_t(std::min_element(costs.begin(), costs.end()) - costs.begin());
    nlohmann::json report = {{"chosen", candidates[best].name}, {"candidates", nlohmann::json::array()}};
    for (size_t i = 0; i < costs.size(); i++) {
        const double times = costs[best] > 0 ? costs[i] / costs[best] : 1;
        report["candidates"].push_back(
            {{"strategy", candidates[i].name}, {"relative_cost", times}, {"pilot_spp", pilots[i].spp}});
        info(fmt::format("auto    {}: {:.3g} times the best's time to equal error ({} pilot samples a pixel){}",
                         candidates[i].label, times, pilots[i].spp, i == best ? ", taken" : ""));
    }
    scene.strategy = candidates[best].scene.strategy;
    return report;
}

// Relaxed math may do what it likes, and some drivers' functions then keep 11 bits. Measured on the spot, as no list
// knows the next driver: a kernel that is the same for all scenes, so that most drivers have it in their cache.
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

int run(const Options &o, const CLI::App &app) {
    set_quiet(o.quiet);
    set_verbose(o.verbose);
    const bool variance = o.layers == "variance";
    RenderSeconds seconds;
    const StopRule rule = stop_rule(o);

    Stopwatch load;
    SceneDescription scene = load_scene(o.scene);
    apply_size(scene, o, app);
    const std::filesystem::path exr =
        o.out.empty() ? scene.file.stem().replace_extension(".exr") : std::filesystem::path(o.out);
    const std::filesystem::path png = std::filesystem::path(exr).replace_extension(".png");
    const bool with_png =
        !o.no_png && (!std::filesystem::exists(exr) || std::filesystem::is_regular_file(exr)); // none beside /dev/null
    if (png == exr)
        throw Error(fmt::format("--output {}: names the EXR file; the PNG goes beside it", exr.string()));
    check_writable(exr);
    if (with_png)
        check_writable(png);
    if (!o.json.empty())
        check_writable(o.json);
    seconds.load = load.seconds();

    const DevicePick pick = pick_device(o.device, list_devices());
    const int lanes = lanes_for(pick.info, scene.strategy.lanes, scene.strategy.math);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene);
    const nlohmann::json choice =
        o.strategy.empty() ? nlohmann::json() : choose_strategy(scene, device, sources, o.seed);
    Stopwatch bvh;
    const FlatScene flat = flatten(scene, lanes);
    seconds.bvh = bvh.seconds();
    tell_what_runs(scene, flat, pick, lanes, o.seed);

    RenderOptions options;
    options.build = {.lanes = lanes, .math = scene.strategy.math, .kernels = "kernels/render.cl"};
    options.sources = &sources;
    if (scene.strategy.math == MathMode::fast)
        warn_of_fast_functions(device, options.build, sources);
    Renderer renderer(device, flat, options);
    renderer.restart(o.seed);
    seconds.compile = renderer.compile_seconds();

    watch_interrupts();
    const double pixels = double(scene.camera.width) * scene.camera.height;
    StopResult stopped;
    {
        const unsigned most = rule.given() && !app.count("--spp") ? most_samples : scene.spp;
        std::optional<Progress> progress; // none where nobody knows yet how much there is to do
        if (rule.seconds > 0)
            progress.emplace("render", rule.seconds, "s");
        else if (!rule.given())
            progress.emplace("render", most * pixels);
        stopped = render_until(renderer, rule, o.seed, most, [&](double samples, double kernel_seconds) {
            if (progress)
                progress->update(rule.seconds > 0 ? kernel_seconds : samples * pixels);
            return !interrupted();
        });
    }
    seconds.render = renderer.kernel_seconds();

    const Film film = renderer.film();
    warn_of_gaps(film, seconds.render);
    Image image = image_of(film, variance);
    nlohmann::json report = report_json(scene, pick.info, lanes, o.seed, film, seconds);
    if (!choice.is_null())
        report["auto"] = choice;
    if (rule.given())
        report["stop"] = stop_json(rule, stopped, film, seconds.render);
    add_metadata(image, report, command_line());
    Stopwatch write;
    write_exr(image, exr);
    if (with_png)
        write_png(image, png);
    seconds.write = write.seconds();

    report["seconds"]["write"] = seconds.write;
    if (!o.json.empty())
        write_safely(o.json, dump(report, 2) + "\n");
    tell_result(report);
    if (rule.given())
        tell_stop(report["stop"], report["spp"].get<double>(), seconds.render);
    info(fmt::format("wrote   {}{}", exr.string(), with_png ? " and " + png.string() : ""));
    if (stopped.complete)
        return 0;
    warn(fmt::format("interrupted: the image holds {:.4g} of {} samples a pixel", report["spp"].get<double>(),
                     stopped.spp));
    return exit_interrupted;
}

} // namespace

RunCommand setup_render(CLI::App &app) {
    auto o = std::make_shared<Options>();
    add_scene_options(app, o->scene);
    add_device_option(app, o->device);
    app.add_option("-o,--output", o->out,
                   "EXR file; the PNG goes beside it (default: the scene's name, in the current folder)");
    app.add_flag("--no-png", o->no_png, "Write no PNG");
    app.add_option("--spp", o->spp, "Samples per pixel (default: the scene's sampleCount)")
        ->check(CLI::Range(1u, 0xffffffffu));
    CLI::Option *time =
        app.add_option("--time", o->time, "Stop after this much kernel time (30s, 2min); --spp is then the most")
            ->type_name("TIME");
    app.add_option("--target-error", o->target_error,
                   "Stop when the relative standard error of the image's mean luminance is below this (1%)\n"
                   "  A pilot of other samples decides how many, so that the image stays unbiased")
        ->type_name("ERROR")
        ->excludes(time);
    app.add_option("--strategy", o->strategy,
                   "auto: short pilots find which way to sample light costs least on this scene and device")
        ->check(CLI::IsMember({"auto"}));
    app.add_option("--width", o->width, "Pixels (default: the scene's; one of both keeps its aspect)")
        ->check(CLI::Range(1, 65535));
    app.add_option("--height", o->height, "Pixels (default: the scene's)")->check(CLI::Range(1, 65535));
    app.add_option("--seed", o->seed, "Of the random numbers; the same seed gives the same image")
        ->capture_default_str();
    app.add_option("--json", o->json, "File for the statistics of the render");
    app.add_option("--layers", o->layers, "More layers for the EXR: variance (of each pixel's mean)")
        ->check(CLI::IsMember({"variance"}));
    CLI::Option *quiet = app.add_flag("--quiet", o->quiet, "Print nothing but warnings and errors");
    app.add_flag("--verbose", o->verbose, "Print what the driver remarks on the kernels, too")->excludes(quiet);
    return [o, &app] { return run(*o, app); };
}

} // namespace opal
