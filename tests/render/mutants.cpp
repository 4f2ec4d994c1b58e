// Negative controls of rendering: wrong kernels that the checks must reject.
#include "support/mutants.h"
#include "support/seeds.h"

#include <catch2/catch.hpp>

using namespace opal::test;

TEST_CASE("Every mutant that furnaces show is killed", "[mutants][stat][long]") {
    require_all_killed(furnace_mutants, test_seed(30));
}
TEST_CASE("Every mutant of the lights is killed", "[mutants][stat][long]") {
    require_all_killed(light_mutants, test_seed(31));
}
TEST_CASE("Every mutant of the strategies is killed", "[mutants][stat][long]") {
    require_all_killed(strategy_mutants, test_seed(32));
}
TEST_CASE("Every mutant of masks, hidden emitters and sample counts is killed", "[mutants][stat][long]") {
    require_all_killed(passing_mutants, test_seed(35));
}
TEST_CASE("Every mutant of discrete choices is killed", "[mutants][stat][long]") {
    require_all_killed(choice_mutants, test_seed(34));
}
TEST_CASE("Every mutant of the film is killed", "[mutants][stat][long]") {
    require_all_killed(film_mutants, test_seed(33));
}
