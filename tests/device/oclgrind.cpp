// The kernels under Oclgrind, which simulates every access: no invalid ones and no races.
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace opal::test;

namespace {

// Runs opal under Oclgrind, without optimisation: Oclgrind 21.10 lacks many intrinsics that optimisation brings in.
Outcome simulate(const ScratchFolder &vendors, const std::string &arguments) {
    return run_shell("OCL_ICD_VENDORS=" + vendors.path().string() +
                     " OCLGRIND_DATA_RACES=1 OCLGRIND_BUILD_OPTIONS='-cl-opt-disable -DOPAL_KEEP_CALLS' " OPAL_BINARY
                     " " +
                     arguments);
}

} // namespace

TEST_CASE("Oclgrind finds no invalid access and no race", "[oclgrind][skips]") {
    const char *const library = "/usr/lib/oclgrind/liboclgrind-rt-icd.so"; // as Debian's package has it
    if (!std::filesystem::exists(library)) {
        WARN("skipped: oclgrind is not installed");
        return;
    }
    const ScratchFolder vendors, output;
    vendors.write("oclgrind.icd", std::string(library) + "\n");
    const std::string scenes = OPAL_SOURCE_DIR "/scenes/", out = " --no-png -o " + (output / "out.exr").string();
    for (const std::string &arguments :
         {std::string("warp bsdf:microfacet --samples 1000 --cells 2"),
          std::string("warp light:many --triangle-choice uniform --samples 1000 --cells 2"),
          "render " + scenes + "cbox_mis.xml --width 2 --height 2 --spp 1" + out,
          "render " + scenes + "mixed_room.xml --width 2 --height 2 --spp 1 --sampler sobol" + out}) {
        const Outcome outcome = simulate(vendors, arguments);
        INFO(arguments << "\n" << outcome.out.substr(0, 2000) << outcome.err.substr(0, 2000));
        CHECK(outcome.exit_code == 0);
        for (const char *finding : {"Invalid", "exceeds static array size", "data race", "Uninitialized", "OCLGRIND"})
            CHECK_THAT(outcome.out + outcome.err, !Catch::Contains(finding));
    }
}
