// `render --time` and `--target-error`: they stop where they say, stay unbiased, and state intervals that cover the
// truth.
#include "render/stop_rules.h"
#include "base/command_line.h"
#include "base/json.h"

#include "base/units.h"
#include "image/image.h"
#include "stats/hypothesis.h"
#include "support/device.h"
#include "support/error_of.h"
#include "support/plain_scenes.h"
#include "support/scratch.h"
#include "support/seeds.h"

#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

// A floor under a lamp far smaller than it: BSDF samples rarely find it, so that the noise is skewed.
SceneDescription noisy_scene() {
    SceneDescription scene = scene_of({diffuse(Parallelogram{{-2, -2, 5}, {0, 4, 0}, {4, 0, 0}}, 0.8f),
                                       light(Parallelogram{{-0.4, -0.4, 4}, {0.8, 0, 0}, {0, 0.8, 0}}, {3, 3, 3})});
    scene.camera.width = 8;
    scene.camera.height = 8;
    scene.strategy[AXIS_lighting] = CHOICE_lighting_bsdf;
    scene.strategy.max_depth = 2;
    return scene;
}

struct Rendering {
    FlatScene flat = flatten(noisy_scene(), 1);
    RenderOptions options{.build = {.lanes = 1}};
    Renderer renderer{device(), flat, options};
    FilmStatistics until(const StopRule &rule, unsigned seed, unsigned most = 1u << 20, StopResult *stopped = nullptr) {
        renderer.restart(seed);
        const StopResult s = render_until(renderer, rule, seed, most, {});
        if (stopped)
            *stopped = s;
        return statistics_of(renderer.film());
    }
};

} // namespace

TEST_CASE("The interval of --target-error covers the true mean as often as it says", "[stop_rules][alone][stat]") {
    Rendering r;
    const FilmStatistics truth = r.until({}, test_seed(1), 1 << 17);
    constexpr double target = 0.05;
    int covered = 0, runs = 100, met = 0;
    stats::Moments means;
    for (int i = 0; i < runs; i++) {
        StopResult stopped;
        const FilmStatistics s = r.until({.relative_error = target}, test_seed(100 + unsigned(i)), 1u << 20, &stopped);
        REQUIRE(s.samples == 64ull * stopped.spp); // the pilot's are not in the film
        const double error = std::hypot(s.stderr_luminance, truth.stderr_luminance);
        covered += std::abs(s.mean_luminance - truth.mean_luminance) <= 1.959964 * error;
        met += s.stderr_luminance <= target * s.mean_luminance;
        means.add(s.mean_luminance);
    }
    INFO(covered << " of 100 intervals cover; " << met << " met the target; mean " << means.mean() << " true "
                 << truth.mean_luminance);
    CHECK_FALSE(stats::binomial_test(covered, runs, 0.95).rejected(1e-4));
    CHECK_FALSE(stats::t_test(means.sample(), truth.mean_luminance).rejected(1e-4)); // unbiased
    CHECK(met >= 60);                                                                // the margin of the pilot
}

TEST_CASE("--target-error takes at most the samples that are allowed, and says so", "[stop_rules][alone]") {
    Rendering r;
    StopResult stopped;
    const FilmStatistics s = r.until({.relative_error = 1e-6}, test_seed(3), 32, &stopped);
    CHECK(stopped.spp == 32);
    CHECK(s.samples == 64 * 32);
    CHECK(s.stderr_luminance > 1e-6 * s.mean_luminance);
}

TEST_CASE("--time ends after that much kernel time, and stops no render that ends before", "[stop_rules][alone]") {
    Rendering r;
    CHECK(r.until({.seconds = 1000}, test_seed(4), 16).samples == 64 * 16);
    StopResult stopped;
    const FilmStatistics s = r.until({.seconds = 0.3}, test_seed(5), 1u << 30, &stopped);
    CHECK(stopped.complete);
    CHECK(s.samples < 64ull << 30);
    CHECK(r.renderer.kernel_seconds() >= 0.3);
    CHECK(r.renderer.kernel_seconds() < 3); // a launch is about 0.1 s
}

TEST_CASE("--time-limit counts from the start of the process, and stops no render that ends before",
          "[stop_rules][alone]") {
    Rendering r;
    CHECK(r.until({.wall_seconds = seconds_since_start() + 1000}, test_seed(4), 16).samples == 64 * 16);
    StopResult stopped;
    const double start = seconds_since_start();
    const FilmStatistics s = r.until({.wall_seconds = start + 0.3}, test_seed(5), 1u << 30, &stopped);
    CHECK(stopped.complete);
    CHECK(s.samples < 64ull << 30);
    CHECK(seconds_since_start() >= start + 0.3);
    CHECK(seconds_since_start() < start + 5);
}

TEST_CASE("A render that its rule ends speaks of no error", "[stop_rules][alone]") {
    const ScratchFolder folder;
    for (const std::string rule : {"--time 0.1s", "--time-limit 1s", "--target-error 5%"}) {
        INFO(rule);
        const std::string json = folder / "a.json";
        const Outcome outcome = run_shell(OPAL_BINARY " " OPAL_SOURCE_DIR "/scenes/furnace.xml --width 32 --no-png " +
                                          rule + " -o /dev/null --json " + json);
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        CHECK_THAT(outcome.err, Catch::Contains("\nstop    after ") && !Catch::Contains("\nerror"));
        const nlohmann::json report = nlohmann::json::parse(read_text(json));
        CHECK("--" + report["stop"]["rule"].get<std::string>() == rule.substr(0, rule.find(' ')));
        CHECK(report["stop"]["wall_seconds"] >= report["stop"]["kernel_seconds"]);
        CHECK(report["interrupted"] == false);
    }
}

// Of many launches a pass, of which --time lets one end.
TEST_CASE("--time too short for a sample a pixel says so, and states no interval", "[stop_rules][alone]") {
    const ScratchFolder folder;
    const std::string scene = OPAL_SOURCE_DIR "/scenes/furnace.xml", exr = folder / "part.exr",
                      json = folder / "part.json";
    const Outcome outcome =
        run_shell(OPAL_BINARY " " + scene + " --width 1024 --height 1024 --time 1ms --layers variance -o " + exr +
                  " --json " + json);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const nlohmann::json report = nlohmann::json::parse(read_text(json));
    const size_t empty = report["empty_pixels"];
    if (empty == 0) {
        WARN("not tested: one launch holds the whole image here");
        return;
    }
    CHECK(double(empty) == Approx((1 - report["spp"].get<double>()) * 1024 * 1024));
    CHECK_THAT(outcome.err, Catch::Contains(fmt::format("warning: {} of 1048576 pixels", empty)) &&
                                Catch::Contains("one sample of every pixel takes about"));
    CHECK_THAT(outcome.err, !Catch::Contains("+-") && !Catch::Contains("confidence"));
    CHECK(report["stderr_luminance"].is_null());
    CHECK(report["stop"]["mean_luminance_interval"].is_null());
    CHECK(report["stop"]["relative_error"].is_null());
    CHECK_THAT(report["warnings"][0].get<std::string>(), Catch::Contains("have no sample"));

    // Nor is it taken for a whole image later.
    CHECK(read_exr(exr).number("opal.empty_pixels") == double(empty));
    const Outcome compared = run_shell(OPAL_BINARY " compare " + exr + " " + exr);
    CHECK_THAT(compared.err, Catch::Contains(fmt::format("part.exr: {} pixels without a sample", empty)));
    CHECK_THAT(compared.out, Catch::Contains("No test of the means: " + exr + " has "));
    const Outcome swept = run_shell(OPAL_BINARY " sweep " + scene + " --width 1024 --reference " + exr + " -o " +
                                    (folder / "sweep").string());
    CHECK(swept.exit_code == 1);
    CHECK_THAT(swept.err, Catch::Contains(fmt::format("{} of its pixels have no sample", empty)));
}

TEST_CASE("Durations and errors are read with their units", "[stop_rules][alone]") {
    CHECK(parse_seconds("30s") == 30);
    CHECK(parse_seconds("500ms") == Approx(0.5));
    CHECK(parse_seconds("2min") == 120);
    CHECK(parse_fraction("1%") == Approx(0.01));
    CHECK(parse_fraction("0.01") == 0.01);
    for (const char *bad : {"", "s", "-1s", "0", "3 parsecs", "nan", "inf"})
        CHECK_THAT(error_of([&] { parse_seconds(bad); }), Catch::Contains("possible: 30s"));
    for (const char *bad : {"", "0%", "100%", "1s", "nan"})
        CHECK_THAT(error_of([&] { parse_fraction(bad); }), Catch::Contains("possible: 1%"));
}
