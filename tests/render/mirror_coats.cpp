// A microfacet coat of alpha 0 is a mirror over a diffuse base.
#include "read/nori/load.h"
#include "selftest/checks.h"
#include "stats/hypothesis.h"
#include "support/pictures.h"
#include "support/scratch.h"
#include "support/seeds.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

constexpr double outside = 1.000277, inside = 1.5046, kd = 0.4, sky = 2;

// A floor under a sky that is equally bright everywhere, seen through a narrow view at 60 degrees.
SceneDescription floor_under_sky(const std::string &integrator, double alpha) {
    const ScratchFolder folder;
    return load_scene(folder.write("floor.xml", fmt::format(R"(<scene>
<integrator type="{}"/>
<camera type="perspective"><float name="fov" value="0.1"/>
<integer name="width" value="16"/><integer name="height" value="16"/>
<transform name="toWorld"><lookat origin="0 1.7320508 1" target="0 0 0" up="0 0 1"/></transform>
<rfilter type="box"/></camera>
<emitter type="constant"><color name="radiance" value="{} {} {}"/></emitter>
<mesh type="parallelogram">
<point name="origin" value="-1 -1 0"/><vector name="u" value="2 0 0"/><vector name="v" value="0 2 0"/>
<bsdf type="microfacet"><float name="alpha" value="{}"/><color name="kd" value="{} {} {}"/></bsdf>
</mesh></scene>)",
                                                            integrator, sky, sky, sky, alpha, kd, kd, kd)));
}

} // namespace

TEST_CASE("Alpha 0 reflects kd of a sky and ks F of its mirror image, in every strategy", "[mirror_coats][stat]") {
    const double expected = sky * (kd + (1 - kd) * fresnel_reflectance(0.5, outside, inside));
    const std::vector<std::pair<std::string, Overrides>> strategies = {
        {"path_mis", {{"lighting", "bsdf"}}},
        {"path_mis", {{"lighting", "emitter"}}},
        {"path_mis", {{"mis", "balance"}}},
        {"path_mis", {{"mis", "power"}}},
        {"direct_lighting", {{"lighting", "bsdf"}}},
        {"direct_lighting", {{"lighting", "emitter"}}},
        {"direct_lighting", {{"lighting", "mis"}, {"mis", "balance"}}},
        {"direct_lighting", {{"lighting", "mis"}, {"mis", "one-sample"}}},
        {"whitted", {}}};
    unsigned seed = 300;
    for (double alpha : {0.0, 1e-30, 1e-8})
        for (const auto &[integrator, overrides] : strategies) {
            INFO(integrator << (overrides.empty() ? "" : " " + overrides.rbegin()->second) << " alpha " << alpha);
            const Film film =
                render(with_strategy(floor_under_sky(integrator, alpha), overrides), 4096, test_seed(seed++));
            CHECK(film.invalid == 0);
            const stats::Sample image = sample_of(film);
            INFO(image.mean << " against " << expected << ", standard error " << std::sqrt(image.variance / image.n));
            CHECK_FALSE(stats::z_test(image, expected).rejected(1e-5));
            CHECK(image.mean == Approx(expected).epsilon(0.01)); // so that noise passes no wrong picture
        }
}
