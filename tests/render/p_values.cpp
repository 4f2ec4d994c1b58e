// The p-values of the tests themselves: they must be uniform where nothing is wrong.
#include "stats/hypothesis.h"
#include "support/device.h"
#include "support/evidence.h"
#include "support/kernel_checks.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

namespace {

// Adds the p-values of independent comparisons by continuous statistics. Sobol's are left out: his numbers' error is
// smaller than the variance says.
void add(std::vector<double> &values, const Findings &findings) {
    for (const Finding &finding : findings)
        if (finding.kind == FigureKind::p_value && finding.figure > 0 && finding.figure < 1 &&
            finding.check.find("sobol") == std::string::npos)
            values.push_back(finding.figure);
}

} // namespace

TEST_CASE("The p-values of the suite are uniform", "[p_values][stat]") {
    const Sources &sources = Sources::embedded();
    std::vector<double> values;
    for (unsigned round = 0; round < 3; round++) {
        const unsigned seed = test_seed(400 + round);
        for (const Check &check :
             {Check(check_independence), Check(check_warps),
              check_of_bsdfs({"diffuse", "microfacet_0.1", "phong_10", "roughconductor_ggx_0.5_0.1",
                              "roughdielectric_0.1", "principled", "oren_nayar", "roughplastic_0.1"}),
              Check(check_albedos), Check(check_furnace), Check(check_triangle_light)})
            add(values, check(sources, seed));
    }
    const stats::TestResult result = stats::ks_uniform_test(values);
    INFO(values.size() << " p-values, Kolmogorov-Smirnov p = " << result.p_value);
    CHECK(values.size() > 150);
    CHECK(result.p_value >= check_level);
}

// The test of images that verify and compare use, on two renders by one strategy.
TEST_CASE("Two seeds of one strategy are not declared different more often than stated", "[p_values][stat]") {
    constexpr unsigned spp = 32;
    constexpr int pairs = 100;
    const Overrides how = GENERATE(Overrides{{"lighting", "bsdf"}}, Overrides{{"lighting", "emitter"}},
                                   Overrides{{"lighting", "mis"}, {"mis", "power"}},
                                   Overrides{{"lighting", "mis"}, {"sampler", "sobol"}});
    CAPTURE(how.begin()->second, how.rbegin()->second);
    SceneDescription scene = with_strategy(gallery(), how);
    scene.strategy.max_depth = 6;
    Renderer renderer = renderer_of(scene);
    const auto picture = [&](unsigned seed) {
        renderer.restart(test_seed(500 + seed));
        renderer.render(spp);
        return image_of(renderer.film(), true);
    };
    const auto test = [&](const Image &a, const Image &b) {
        return stats::tile_test(estimate_of(a, spp, spp - 1), estimate_of(b, spp, spp - 1));
    };
    int declared = 0, seen = 0;
    double smallest = 1;
    for (unsigned pair = 0; pair < pairs; pair++) {
        const Image a = picture(2 * pair);
        Image b = picture(2 * pair + 1);
        const stats::TileTest same = test(a, b);
        declared += same.rejected(0.05);
        smallest = std::min(smallest, same.p_value);
        for (Layer &layer : b.layers) // the negative control
            if (!layer.name.starts_with("variance."))
                for (float &value : layer.values)
                    value *= 1.3f;
        seen += test(a, b).rejected(0.05);
    }
    INFO(declared << " of 100 pairs declared different at 5 %, smallest p " << smallest << "; " << seen
                  << " of those 30 % apart");
    CHECK((declared <= 5 || stats::binomial_test(declared, pairs, 0.05).p_value >= check_level));
    CHECK(stats::sidak_p(smallest, pairs) >= check_level);
    CHECK(seen >= 90);
}
