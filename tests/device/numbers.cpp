// Random numbers as the kernels draw them.
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

TEST_CASE("Random numbers are the known ones, bit for bit, and never 1", "[numbers]") {
    require_all_pass(check_known_numbers(Sources::embedded(), 0));
}
TEST_CASE("Sobol points lie one in each elementary interval", "[numbers]") {
    require_all_pass(check_sobol(Sources::embedded(), test_seed(100)));
}
TEST_CASE("Strata are met once each, in an order of their own", "[numbers][stat]") {
    require_all_pass(check_stratified(Sources::embedded(), test_seed(101)));
}
TEST_CASE("Every dimension of a path has a key of its own", "[numbers]") {
    require_all_pass(check_dimensions(Sources::embedded(), 0));
}
TEST_CASE("Pixels, samples, dimensions and seeds are uncorrelated", "[numbers][stat]") {
    require_all_pass(check_independence(Sources::embedded(), test_seed(102)));
}
