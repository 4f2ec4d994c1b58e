// Warps, BSDFs and emitters: what they draw, and what they say of its density.
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

TEST_CASE("Warps draw by their densities", "[sampling]") {
    require_all_pass(check_warps(Sources::embedded(), test_seed(120)));
}
TEST_CASE("BSDFs draw by their densities, weigh by f cos / pdf and are reciprocal", "[sampling]") {
    require_all_pass(check_bsdfs(Sources::embedded(), test_seed(121)));
}
TEST_CASE("Albedos are those of quadrature, and never above 1", "[sampling]") {
    require_all_pass(check_albedos(Sources::embedded(), test_seed(122)));
}
TEST_CASE("Parts of BSDFs are drawn with the probability that the density states", "[sampling]") {
    require_all_pass(check_choices(Sources::embedded(), 0));
}
TEST_CASE("Emitters draw by their densities", "[sampling]") {
    require_all_pass(check_emitters(Sources::embedded(), test_seed(123)));
}
