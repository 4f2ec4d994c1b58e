// Warps, BSDFs and emitters: what they draw, and what they say of its density.
#include "support/device.h"
#include "support/error_of.h"
#include "support/kernel_checks.h"
#include "support/scratch.h"
#include "support/seeds.h"

#include <set>

using namespace opal;
using namespace opal::test;

namespace {

// The checks that fail, each by itself.
std::set<std::string> failing(const Findings &findings) {
    std::set<std::string> checks;
    for (const Finding &finding : findings)
        if (rejected({finding}))
            checks.insert(finding.check);
    return checks;
}

} // namespace

TEST_CASE("Warps draw by their densities", "[sampling][stat]") {
    require_all_pass(check_warps(Sources::embedded(), test_seed(120)));
}
TEST_CASE("BSDFs draw by their densities, weigh by f cos / pdf and are reciprocal", "[sampling][stat]") {
    require_all_pass(check_bsdfs(Sources::embedded(), test_seed(121)));
}
TEST_CASE("Normals of facets are drawn by their densities, which integrate to 1", "[sampling][facets][stat]") {
    require_all_pass(check_facets(Sources::embedded(), test_seed(126)));
}
TEST_CASE("Albedos are those of quadrature, and never above 1", "[sampling][stat]") {
    require_all_pass(check_albedos(Sources::embedded(), test_seed(122)));
}
TEST_CASE("Parts of BSDFs are drawn with the probability that the density states", "[sampling]") {
    require_all_pass(check_choices(Sources::embedded(), 0));
}
TEST_CASE("Emitters draw by their densities", "[sampling][stat]") {
    require_all_pass(check_emitters(Sources::embedded(), test_seed(123)));
}
TEST_CASE("Lights that are spheres, from near, far and inside", "[sampling][stat]") {
    require_all_pass(check_sphere_lights(Sources::embedded(), test_seed(125)));
}
TEST_CASE("Lights with a texture are sampled with the radiance that rays find", "[sampling]") {
    require_all_pass(check_textured_lights(Sources::embedded(), test_seed(126)));
}

TEST_CASE("Environments have Mitsuba's radiance and density", "[sampling][environments]") {
    require_all_pass(check_environments(Sources::embedded(), 0));
}
TEST_CASE("Environments draw by their densities", "[sampling][environments][stat]") {
    require_all_pass(check_skies(Sources::embedded(), test_seed(126)));
}

TEST_CASE("A file dropped among the cases is tested, and a wrong one fails", "[sampling]") {
    const ScratchFolder folder;
    folder.write("bright.xml", "<bsdf type='diffuse'><color name='albedo' value='1.1 0.5 0.5'/></bsdf>");
    folder.write("fine.xml", "<bsdf type='diffuse'><color name='albedo' value='0.9 0.5 0.5'/></bsdf>");
    const std::vector<Material> materials = bsdf_cases(folder.path());
    REQUIRE(materials.size() == 2);
    CHECK(failing(check_materials({materials[0]}, Sources::embedded(), test_seed(124))) ==
          std::set<std::string>{"BSDFs: albedo less 5 standard errors"});
    CHECK(failing(check_materials({materials[1]}, Sources::embedded(), test_seed(124))).empty());

    folder.write("wrong/bsdf.xml", "<bsdf type='difuse'/>");
    CHECK_THAT(error_of([&] { bsdf_cases(folder / "wrong"); }), Catch::Contains("did you mean 'diffuse'"));
    folder.write("lights/outside.xml",
                 "<mesh type='parallelogram'><point name='origin' value='0 0 1'/><vector name='u' value='1 0 0'/>"
                 "<vector name='v' value='0 1 0'/><emitter type='area'><color name='radiance' value='1 1 1'/></emitter>"
                 "</mesh>");
    CHECK_THAT(error_of([&] { emitter_cases(folder / "lights"); }),
               Catch::Contains("does not lie in the unit square of the plane z = 0"));
}
