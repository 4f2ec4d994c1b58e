// Negative controls of what is drawn: wrong warps, BSDFs, lights and cameras that the checks must reject.
#include "support/mutants.h"
#include "support/seeds.h"

#include <catch2/catch.hpp>

using namespace opal::test;

TEST_CASE("Every mutant of what is drawn is killed", "[density_mutants][stat][long]") {
    require_all_killed(density_mutants, test_seed(142));
}
