// scripts/gpu_check where it cannot check: one clear sentence, an exit code of its own, nothing written.
#include "support/scratch.h"

#include <catch2/catch.hpp>

using namespace opal::test;

namespace {

const std::string gpu_check = OPAL_SOURCE_DIR "/scripts/gpu_check --opal " OPAL_BINARY;

} // namespace

TEST_CASE("gpu_check says that there is no GPU, and ends with 3", "[gpu_check]") {
    const ScratchFolder vendors; // no driver
    const Outcome outcome =
        run_shell("OCL_ICD_FILENAMES= OCL_ICD_VENDORS=" + vendors.path().string() + " " + gpu_check);
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 3);
    CHECK_THAT(outcome.err, Catch::StartsWith("gpu_check: no GPU: no OpenCL device \"gpu\"") &&
                                Catch::Contains("OCL_ICD_VENDORS is set, so no other driver was looked for"));
    CHECK(outcome.out.empty());
}

TEST_CASE("gpu_check --pack touches no folder that exists", "[gpu_check]") {
    const ScratchFolder folder;
    folder.write("pack/mine", "kept");
    const Outcome outcome = run_shell(gpu_check + " --pack " + (folder / "pack").string());
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 2);
    CHECK_THAT(outcome.err, Catch::Contains((folder / "pack").string() + ": it exists"));
    CHECK(read_text(folder / "pack/mine") == "kept");
    CHECK(!std::filesystem::exists(folder / "pack.part"));
}
