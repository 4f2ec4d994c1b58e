// Negative controls of rendering: wrong kernels that the checks must reject.
#include "support/device.h"
#include "support/mutants.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

namespace {

const std::vector<Control> controls = {
    // Furnace
    {{"dropped cosine of uniform sampling", "bsdfs/diffuse.cl", "b.use_cosine ? (real)(1) : 2 * wo.z", "b.use_cosine ? (real)(1) : (real)(1)"}, "agreement", check_agreement},
    {{"emitter counted twice at the first hit", "integrators/path.cl", "v3_mul(path->throughput, emitted(scene, path, s, hit, found))",
      "v3_scale(v3_mul(path->throughput, emitted(scene, path, s, hit, found)), to_real(to_ints(path->depth == 1u) ? (uints)(2) : (uints)(1)))"},
     "furnace", check_furnace},
    {{"roulette without division", "lighting.cl", "plays ? 1 / survival : (real)(1)", "(real)(1)"}, "furnace", check_furnace},
    {{"roulette that divides by what it draws next", "lighting.cl", "return live & (!plays | (u < survival));", "return live & (!plays | (u < square(survival)));"},
     "furnace", check_furnace},
    {{"weight of the light's sample kept where the BSDF's is dropped", "lighting.cl", "radiance = v3_scale(radiance, path->direct ? (real)(1) : mis_weight(scene, ratio));", ";"},
     "furnace", check_furnace},
};

} // namespace

TEST_CASE("A mutant whose text is not there is an error", "[mutants]") {
    const Mutant mutant{"none", "math.cl", "no such text", ""};
    CHECK_THROWS_WITH(mutated(Sources::embedded(), mutant), Catch::Contains("mutant \"none\"") && Catch::Contains("cl/math.cl"));
    CHECK_THROWS_AS(mutated(Sources::embedded(), {"many", "math.cl", "real", ""}), Error);
    CHECK_THROWS_AS(mutated(Sources::embedded(), {"nowhere", "maths.cl", "real", ""}), Error);
}

TEST_CASE("Every mutant of the rendering is killed", "[mutants]") { require_all_killed(controls, test_seed(30)); }
