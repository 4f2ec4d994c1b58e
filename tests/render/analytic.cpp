// Scenes whose pixels are known on paper (derivations in support/rooms.h).
#include "stats/hypothesis.h"
#include "support/checks.h"
#include "support/device.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

TEST_CASE("A furnace shows emitted / (1 - albedo) in every strategy", "[analytic][stat]") {
    require_all_pass(check_furnace(Sources::embedded(), test_seed(1)));
}

TEST_CASE("Light in glass is n^2 brighter, sample by sample", "[analytic]") {
    require_all_pass(check_glass_furnace(Sources::embedded(), test_seed(2)));
}

TEST_CASE("A triangle light over a floor follows Lambert's formula", "[analytic][stat]") {
    require_all_pass(check_triangle_light(Sources::embedded(), test_seed(3)));
}

TEST_CASE("A sphere light follows the formula for its irradiance, and a round furnace is one", "[analytic][stat]") {
    require_all_pass(check_sphere_light(Sources::embedded(), test_seed(6)));
}

TEST_CASE("A point light follows the inverse square", "[analytic][stat]") {
    require_all_pass(check_point_light(Sources::embedded(), test_seed(4)));
}

TEST_CASE("A last segment is left out only where it meets no light that counts", "[analytic][stat]") {
    require_all_pass(check_last_segments(Sources::embedded(), test_seed(7)));
}

TEST_CASE("Interpolated normals point away from the middle", "[analytic]") {
    require_all_pass(check_smooth_normals(Sources::embedded(), test_seed(5)));
}

TEST_CASE("Discrete choices are right to one part in a million", "[analytic]") {
    require_all_pass(check_counted(Sources::embedded(), 0));
}
