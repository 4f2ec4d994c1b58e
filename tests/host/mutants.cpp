// The texts that mutants replace. That the mutants are killed is tested on the device, mostly under the label `long`.
#include "support/mutants.h"
#include "base/error.h"

#include <catch2/catch.hpp>

using namespace opal;
using namespace opal::test;

TEST_CASE("Each mutant's text stands in the kernels once", "[mutants]") {
    const Sources sources = Sources::embedded();
    for (const std::vector<Control> *controls :
         {&number_mutants, &hit_mutants, &density_mutants, &furnace_mutants, &light_mutants, &strategy_mutants,
          &passing_mutants, &choice_mutants, &film_mutants}) {
        CHECK_FALSE(controls->empty());
        for (const Control &control : *controls)
            CHECK_NOTHROW(mutated(sources, control.mutant));
    }
}

TEST_CASE("A mutant whose text is not there is an error", "[mutants]") {
    const Mutant mutant{"none", "core/math.cl", "no such text", ""};
    CHECK_THROWS_WITH(mutated(Sources::embedded(), mutant),
                      Catch::Contains("mutant \"none\"") && Catch::Contains("cl/core/math.cl"));
    CHECK_THROWS_AS(mutated(Sources::embedded(), {"many", "core/math.cl", "real", ""}), Error);
    CHECK_THROWS_AS(mutated(Sources::embedded(), {"nowhere", "maths.cl", "real", ""}), Error);
}
