// Every strategy against every other on one scene, by the specialised kernels that a user gets: Welch's test per tile
// and on the whole image. Images that disagree stay in evidence/. check_agreement does the same with the general
// kernel.
#include "stats/hypothesis.h"
#include "support/checks.h"
#include "support/device.h"
#include "support/evidence.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/seeds.h"

#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

std::string name_of(const Overrides &how) {
    std::string name;
    for (const auto &[axis, choice] : how)
        name += (name.empty() ? "" : "_") + axis + "-" + choice;
    return name;
}

void require_agreement(const SceneDescription &scene, unsigned spp, const std::vector<Overrides> &strategies) {
    std::vector<Image> images;
    for (const Overrides &how : strategies) {
        SceneDescription chosen = with_strategy(scene, how);
        chosen.spp = spp;
        const Film film = render(chosen, spp, test_seed(200 + unsigned(images.size())));
        INFO(name_of(how));
        CHECK(film.invalid == 0);
        images.push_back(image_of(film, true));
    }
    const double pairs = double(images.size() * (images.size() - 1)) / 2;
    for (size_t i = 0; i < images.size(); i++)
        for (size_t j = 0; j < i; j++) {
            const Verdict verdict =
                same_picture(name_of(strategies[i]) + "--" + name_of(strategies[j]), estimated(images[i], spp),
                             estimated(images[j], spp), stats::sidak_level(check_level, pairs));
            INFO(verdict.message);
            CHECK(verdict.agrees);
        }
}

} // namespace

TEST_CASE("Strategies of one expectation agree in the general kernel", "[strategies][stat]") {
    require_all_pass(check_agreement(Sources::embedded(), test_seed(10)));
}

TEST_CASE("All ways to trace paths give one picture", "[strategies][stat]") {
    SceneDescription scene = gallery();
    scene.strategy.max_depth = 8; // so that --rr off ends, in a closed room
    require_agreement(
        scene, 128,
        {{{"lighting", "bsdf"}, {"hemisphere", "uniform"}, {"rr", "throughput"}},
         {{"lighting", "bsdf"}, {"hemisphere", "cosine"}, {"sampler", "sobol"}, {"rr", "off"}},
         {{"lighting", "emitter"}, {"rr", "fixed"}, {"rr-prob", "0.8"}},
         {{"lighting", "emitter"}, {"emitter-choice", "uniform"}, {"rr", "throughput-eta"}},
         {{"lighting", "emitter"}, {"triangle-choice", "uniform"}, {"sampler", "stratified"}, {"rr", "off"}},
         {{"lighting", "mis"}, {"mis", "balance"}, {"rr", "throughput"}, {"rr-depth", "1"}},
         {{"lighting", "mis"}, {"mis", "power"}, {"hemisphere", "uniform"}, {"rr", "throughput-eta"}},
         {{"lighting", "mis"},
          {"mis", "power"},
          {"emitter-choice", "uniform"},
          {"triangle-choice", "uniform"},
          {"sampler", "sobol"},
          {"rr", "fixed"}},
         {{"lighting", "mis"}, {"math", "fast"}, {"rr", "throughput"}}});
}

TEST_CASE("All ways to gather direct light give one picture", "[strategies][stat]") {
    require_agreement(
        matte_gallery(), 128,
        {{{"integrator", "direct_lighting"}, {"lighting", "bsdf"}, {"hemisphere", "cosine"}},
         {{"integrator", "direct_lighting"}, {"lighting", "emitter"}, {"sampler", "stratified"}},
         {{"integrator", "direct_lighting"}, {"lighting", "mis"}, {"mis", "one-sample"}, {"emitter-choice", "uniform"}},
         {{"integrator", "direct_lighting"}, {"lighting", "mis"}, {"mis", "power"}, {"triangle-choice", "uniform"}},
         {{"integrator", "whitted"}},
         {{"integrator", "path_mis"}, {"max-depth", "2"}, {"sampler", "sobol"}}});
}
