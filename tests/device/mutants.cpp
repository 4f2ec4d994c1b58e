// Negative controls of random numbers and intersection: wrong kernels that the checks must reject.
#include "support/mutants.h"
#include "support/seeds.h"

#include <catch2/catch.hpp>

using namespace opal::test;

TEST_CASE("Every mutant of the random numbers is killed", "[mutants][stat]") {
    require_all_killed(number_mutants, test_seed(140));
}
TEST_CASE("Every mutant of the intersection is killed", "[mutants][stat]") {
    require_all_killed(hit_mutants, test_seed(141));
}
