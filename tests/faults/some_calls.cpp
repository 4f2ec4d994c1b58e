// Errors and signals at some of the system calls that a render makes on its files; tests/faults/every_call.cpp has all.
#include "support/faults.h"

#include <catch2/catch.hpp>

using namespace opal::test;

TEST_CASE("An error or a signal at a call on a file leaves the old file or the new one", "[some_calls][alone]") {
    const bool over_old_files = GENERATE(false, true);
    const FaultyRender render(over_old_files);
    size_t turn = over_old_files ? 3 : 0; // each call meets one fault, and another one over old files
    for (long call = 1; call <= render.calls(); call++, turn++)
        CHECK(render.broken_by(fault_names()[turn % fault_names().size()], call) == "");
}
