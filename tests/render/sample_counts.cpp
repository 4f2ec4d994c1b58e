// direct_lighting with several samples of a kind: Veach's multi-sample estimator (1997, eq. 9.8).
#include "support/checks.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/seeds.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

Overrides direct(const std::string &lighting, const std::string &mis, unsigned emitter, unsigned bsdf) {
    return {{"integrator", "direct_lighting"},
            {"lighting", lighting},
            {"mis", mis},
            {"emitter-samples", std::to_string(emitter)},
            {"bsdf-samples", std::to_string(bsdf)}};
}

} // namespace

TEST_CASE("Counts of samples change no mean", "[sample_counts][stat]") {
    require_all_pass(check_sample_counts(Sources::embedded(), test_seed(330)));
    require_all_pass(check_sample_counts_specialised(test_seed(331)));
}

TEST_CASE("n samples of the one kind that is taken have 1/n of its variance", "[sample_counts][stat]") {
    const auto variance = [](const char *lighting, unsigned count, unsigned seed) {
        const Film film =
            render(with_strategy(triangle_light(), direct(lighting, "balance", count, count)), 16384, test_seed(seed));
        return sample_of(film, 0).variance;
    };
    for (const char *lighting : {"emitter", "bsdf"})
        CHECK(variance(lighting, 1, 380) / variance(lighting, 5, 381) == Approx(5).epsilon(0.05));
}

TEST_CASE("More samples of one kind shift the weights to it", "[sample_counts][stat]") {
    // Of a floor and a small light, light samples are good. Eight of them beside one BSDF sample have a variance near
    // that of eight alone; with the weights of one sample each it would be far larger.
    const auto variance = [](const char *lighting, unsigned seed) {
        const Film film =
            render(with_strategy(triangle_light(), direct(lighting, "balance", 8, 1)), 16384, test_seed(seed));
        return sample_of(film, 0).variance;
    };
    CHECK(variance("mis", 390) < 1.5 * variance("emitter", 391));
}

TEST_CASE("Each sample has random numbers of its own", "[sample_counts]") {
    // The same numbers twice would give the picture of one sample.
    const SceneDescription scene = triangle_light();
    const Film one = render(with_strategy(scene, direct("emitter", "balance", 1, 1)), 1, 7),
               two = render(with_strategy(scene, direct("emitter", "balance", 2, 1)), 1, 7);
    CHECK(sample_of(one, 0).mean != sample_of(two, 0).mean);
}

TEST_CASE("Lights reflect where the scene says so", "[sample_counts][stat]") {
    // The floor emits, too. Paths of two segments show what it reflects; direct_lighting of Nori does not.
    SceneDescription scene = triangle_light();
    scene.meshes[0].radiance = Color{2, 2, 2};
    const auto mean = [&](bool reflects, const Overrides &how) {
        scene.lights_reflect = reflects;
        return sample_of(render(with_strategy(scene, how), 8192, test_seed(395)), 0).mean;
    };
    for (const Overrides &how : {direct("mis", "power", 1, 1), direct("mis", "power", 2, 3)}) {
        CHECK(mean(false, how) == Approx(2));
        CHECK(mean(true, how) == Approx(2 + triangle_light_truth()).epsilon(0.01));
    }
    CHECK(mean(false, {}) == Approx(2 + triangle_light_truth()).epsilon(0.01));
}

TEST_CASE("One sample of either kind takes no counts", "[sample_counts]") {
    CHECK_THROWS_WITH(with_strategy(triangle_light(), direct("mis", "one-sample", 2, 1)),
                      Catch::Contains("mis one-sample with emitter-samples 2 and bsdf-samples 1 makes no sense"));
}
