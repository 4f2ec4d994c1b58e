// opal verify: do all unbiased strategies agree on a scene?
#include "base/error.h"
#include "base/exit_code.h"
#include "base/file_use.h"
#include "base/json.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/signals.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "commands/vary.h"
#include "compare/agreement.h"
#include "flatten/features.h"
#include "image/metrics.h"
#include "render/kernel_choice.h"
#include "render/renderer.h"

#include <fmt/format.h>

namespace opal {

namespace {

constexpr int default_side = 32; // pixels of the longer side; samples matter more here than pixels
constexpr unsigned least_spp = 32;
constexpr unsigned strata = 1024; // of the stratified sampler, which repeats after them

struct Options {
    SceneOptions scene;
    DeviceOptions device;
    std::string strategies, out, vary, json;
    double budget = 60, significance = 1e-3;
    int width = 0, height = 0;
    unsigned seed = 0;
    bool quiet = false;
};

class Clock {
public:
    explicit Clock(double budget) : budget_(budget) {}
    double left() const {
        return budget_ - std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    double budget_;
};

// Sets a box filter, so that pixels are independent, and a small image, in the scene's aspect unless both sides are
// given.
void simplify_image(Camera &camera, const Options &o) {
    const double aspect = double(camera.width) / camera.height;
    const auto side = [](double pixels) { return std::max(1, int(std::lround(pixels))); };
    int width = o.width, height = o.height;
    if (!width && !height)
        (aspect >= 1 ? width : height) = default_side;
    camera.width = width ? width : side(height * aspect);
    camera.height = height ? height : side(width / aspect);
    camera.filter = Filter{};
}

Clock clock_of(const Options &o) { return Clock(0.97 * o.budget); } // the rest is for the tests

std::vector<NamedStrategy> choose(const SceneDescription &scene, const Options &o) {
    std::vector<NamedStrategy> strategies = o.strategies.empty()
                                                ? sensible_strategies(scene)
                                                : as_usage([&] { return named_strategies(scene, o.strategies); });
    if (strategies.size() < 2)
        throw UsageError(
            fmt::format("nothing to hold against each other: {} strategy; --strategies names at least two, as in "
                        "lighting=mis,mis=power;lighting=emitter",
                        strategies.size()));
    return strategies;
}

std::vector<FlatScene> flatten_all(SceneDescription scene, const std::vector<NamedStrategy> &strategies,
                                   const DeviceInfo &device, bool own_kernels) {
    std::vector<FlatScene> scenes;
    for (const NamedStrategy &s : strategies) {
        scene.strategy = s.strategy;
        scenes.push_back(flatten(scene, lanes_for(device, s.strategy.lanes, s.strategy.math)));
    }
    // One kernel for all strategies (shared_features): compiling one for each would take most of the time.
    const Features shared = shared_features(scenes);
    for (size_t i = 0; !own_kernels && i < scenes.size(); i++)
        scenes[i].features = shared;
    return scenes;
}

// Renders up to sample `end`. False when interrupted. Throws Error if paths that may be endless do not end in time.
bool render_in_time(Renderer &renderer, unsigned end, const Clock &clock, const std::string &label) {
    const auto goes_on = [&](double, double) {
        return !interrupted() && !(renderer.has_endless_paths() && clock.left() < 0);
    };
    if (renderer.render(end, goes_on))
        return true;
    if (!interrupted())
        throw Error(fmt::format("strategy {}: its paths do not end within the budget; give --max-depth or another --rr",
                                label));
    return false;
}

// Renders whole passes for about that many seconds. False when interrupted.
bool render_for(Renderer &renderer, double seconds, const std::string &label) {
    const Clock clock(seconds);
    unsigned end = least_spp;
    while (true) {
        if (!render_in_time(renderer, end, clock, label))
            return false;
        const double left = clock.left(), a_sample = (seconds - left) / end;
        const double more = std::min(left, 4 * a_sample * end) / a_sample;
        if (left < 0.1 * seconds || more < 1)
            return true;
        end += unsigned(more);
    }
}

std::vector<StrategyRender> render_all(const Options &o, const std::vector<NamedStrategy> &strategies,
                                       const std::vector<FlatScene> &scenes, const Device &device, const Clock &clock) {
    const Sources sources = load_sources(o.scene.cl_dir);
    std::vector<StrategyRender> renders;
    RunningProgress progress("verify");
    progress.expect(clock.left());
    for (size_t i = 0; i < strategies.size() && !interrupted(); i++) {
        const Strategy &s = strategies[i].strategy;
        RenderOptions options;
        options.build.lanes = lanes_for(device.info, s.lanes, s.math);
        options.build.math = s.math;
        options.sources = &sources;
        Renderer renderer(device, scenes[i], options);
        // Drivers finish compiling here, outside the strategy's time.
        if (!render_in_time(renderer, 1, clock, strategies[i].name))
            break;
        renderer.restart(o.seed + unsigned(i));
        if (!render_for(renderer, std::max(0.0, clock.left() / double(strategies.size() - i)), strategies[i].name))
            break;
        const Film film = renderer.film();
        renders.push_back({strategies[i], image_of(film, true), double(renderer.next_sample()), film.invalid,
                           renderer.kernel_seconds()});
    }
    return renders;
}

constexpr const char *evidence_report = "verify.json"; // in the folder

void leave_evidence(const std::filesystem::path &folder, const Agreement &agreement,
                    const std::vector<StrategyRender> &renders, const nlohmann::json &report) {
    const PairTest &worst = agreement.worst();
    write_evidence(folder, renders[worst.a].image, renders[worst.b].image, worst.test);
    for (size_t i = 0; i < renders.size(); i++)
        write_exr(renders[i].image, folder / fmt::format("strategy_{}.exr", i + 1));
    write_safely(folder / evidence_report, dump(report, 2) + "\n");
    print("evidence: {} (image: strategy {}, reference: strategy {})\n", folder.string(), worst.a + 1, worst.b + 1);
}

// Verifies one scene, and reports on it. folder: for the evidence.
int verify(const Options &o, SceneDescription scene, const std::filesystem::path &folder, const Clock &clock,
           nlohmann::json &report) {
    simplify_image(scene.camera, o);
    scene.spp = strata;
    const DevicePick pick = choose_device(o.device);
    scene.strategy.few_paths = suits_general_kernel(pick.info, paths_in(pick.info, o.budget));
    const std::vector<NamedStrategy> strategies = choose(scene, o);
    info(fmt::format("verify  {}: {} strategies, {} x {} pixels, {} in all, seed {}", scene.file.string(),
                     strategies.size(), scene.camera.width, scene.camera.height, duration_text(o.budget), o.seed));
    info(fmt::format("device  {}", text_of(pick)));
    const auto specialise = o.scene.overrides.find("specialise");
    const bool own_kernels = specialise != o.scene.overrides.end();
    const std::vector<FlatScene> scenes = flatten_all(scene, strategies, pick.info, own_kernels);
    const Device device = open_device(pick.info);
    watch_interrupts();
    std::vector<StrategyRender> renders = render_all(o, strategies, scenes, device, clock);
    for (StrategyRender &render : renders)
        render.image.metadata.insert({{"opal.dialect", name_of(scene.dialect)}, {"opal.scene_hash", scene.hash}});
    if (renders.size() < strategies.size()) {
        warn(fmt::format("interrupted after {} of {} strategies: no verdict", renders.size(), strategies.size()));
        return interrupt_exit_code();
    }
    if (clock.left() < -0.25 * o.budget)
        warn(fmt::format(
            "the budget of {} was exceeded by {:.0f} s: compiling, and {} samples a pixel of each at the least",
            duration_text(o.budget), -clock.left(), least_spp));

    for (const StrategyRender &render : renders)
        if (const size_t count = invalid_pixels(render.image).count)
            throw Error(fmt::format("{}: {}: {} pixels of the mean image are NaN or infinite, so that nothing can be "
                                    "told",
                                    scene.file.string(), render.how.name, count));
    const Agreement agreement = test_agreement(renders, o.significance);
    report = json_of(agreement, renders);
    report.update(object({{"scene", scene.file.string()},
                          {"scene_hash", scene.hash},
                          {"dialect", name_of(scene.dialect)},
                          {"definitions", scene.definitions},
                          {"device", pick.info.name},
                          {"driver", pick.info.driver},
                          {"seed", o.seed},
                          {"width", scene.camera.width},
                          {"height", scene.camera.height},
                          {"budget", o.budget}}));
    print_text(text_of(agreement, renders));
    if (!agreement.holds() || !o.out.empty())
        leave_evidence(folder, agreement, renders, report);
    return agreement.holds() ? exit_done : exit_check_failed;
}

int verify_values(const Options &o, const std::filesystem::path &folder) {
    Variation variation = load_variation(o.scene, o.vary);
    nlohmann::json values = nlohmann::json::array();
    bool all_agree = true;
    std::string table = fmt::format("{:<20}  {:<8}  {:<10}  pairs that disagree, samples that are NaN or infinite\n",
                                    variation.name, "verdict", "p-value");
    for (Variant &variant : variation.variants) {
        print("{}={}\n", variation.name, variant.value);
        nlohmann::json report;
        const int code = verify(o, std::move(variant.scene), folder / variant.folder, clock_of(o), report);
        if (code != exit_done && code != exit_check_failed)
            return code;
        all_agree = all_agree && code == exit_done;
        table += fmt::format("{:<20}  {:<8}  {:<10.3g}  {} of {}, {}\n", variant.value,
                             code == exit_done ? "agree" : "DISAGREE", report["p_value"].get<double>(),
                             report["rejected_pairs"].get<size_t>(), report["pairs"].size(),
                             report["invalid_samples"].get<unsigned long long>());
        report["value"] = variant.value;
        values.push_back(std::move(report));
    }
    print_text(table);
    write_json(o.json, "verify", object({{"vary", variation.name}, {"agree", all_agree}, {"values", values}}));
    return all_agree ? exit_done : exit_check_failed;
}

int run(const Options &o) {
    const Clock clock = clock_of(o);
    set_quiet(o.quiet);
    const std::filesystem::path folder = o.out.empty() ? "verify_" + o.scene.file.stem().string() : o.out;
    if (!std::filesystem::is_directory(folder))
        check_writable(folder);
    const OwnFiles own = {folder, {evidence_report, "strategy_", "image.", "reference.", "difference.", "z.", "p."}};
    if (!o.vary.empty()) {
        prepare_json(o.json, own);
        return verify_values(o, folder);
    }
    SceneDescription scene = load_scene(o.scene);
    check_own_files(folder, own.beginnings);
    prepare_json(o.json, own);
    nlohmann::json report;
    const int code = verify(o, std::move(scene), folder, clock, report);
    if (!report.is_null()) // null: interrupted
        write_json(o.json, "verify", report);
    return code;
}

} // namespace

Command verify_command() {
    auto o = std::make_shared<Options>();
    return {
        .name = "verify",
        .help = "Test whether all unbiased strategies give the same mean image of a scene",
        .options = append(
            scene_rows(o->scene),
            {device_row(o->device),
             threads_row(o->device),
             {.flags = "--strategies",
              .target = &o->strategies,
              .help = "Those to test, 'lighting=mis,mis=power;lighting=emitter' [all that make sense here, or where "
                      "these are more than 12 a set in which each pair of choices occurs]",
              .type = "STRATEGIES"},
             {.flags = "--budget",
              .target = &o->budget,
              .help = "Time for all strategies together: 60s, 2min, 1h",
              .check = Duration{},
              .type = "TIME",
              .default_text = "60s"},
             {.flags = "--significance",
              .target = &o->significance,
              .help = "Probability of a false alarm",
              .check = Range{1e-12, 0.5}},
             {.flags = "--width",
              .target = &o->width,
              .help = "Pixels [32 on the longer side, the scene's aspect]",
              .check = Range{1, 65535}},
             {.flags = "--height", .target = &o->height, .help = "Pixels [as --width]", .check = Range{1, 65535}},
             {.flags = "--seed", .target = &o->seed, .help = "Seed of the random numbers"},
             vary_row(o->vary, "one verification a value, each with the whole budget and its evidence in the folder "
                               "NAME=V below -o, and a table of the verdicts"),
             {.flags = "-o,--output",
              .target = &o->out,
              .help = "Folder for the evidence [verify_SCENE, on disagreement only]",
              .type = "FOLDER"},
             json_row(o->json, "the results"),
             {.flags = "--quiet", .target = &o->quiet, .help = "Print nothing but the verdict, warnings and errors"}}),
        .examples = {"opal verify scenes/cbox_mis.xml",
                     "opal verify scenes/mixed_room.xml --budget 5min --json verify.json"},
        .run = [o] { return run(*o); }};
}

} // namespace opal
