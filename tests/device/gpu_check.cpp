// scripts/gpu_check from a packed folder, on a CPU device that says it is a GPU: right kernels pass, wrong ones do not.
#include "support/mutants.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

using namespace opal::test;

namespace {

// A stand-in for opal that renders and tests itself with the kernels of that folder.
std::string opal_with(const ScratchFolder &folder, const std::string &cl_dir) {
    const std::string add = "case $1 in render | selftest) set -- \"$@\" --cl-dir " + cl_dir + " ;; esac";
    const std::string text = "#!/bin/sh\n" + add + "\nexec " OPAL_BINARY " \"$@\"\n";
    const std::filesystem::path script = folder.write("opal", text);
    std::filesystem::permissions(script, std::filesystem::perms::owner_exec, std::filesystem::perm_options::add);
    return script.string();
}

void check_table(const Outcome &outcome, int exit_code, const std::vector<std::string> &rows) {
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == exit_code);
    for (const std::string &row : rows)
        CHECK_THAT(outcome.out, Catch::Contains(row));
}

} // namespace

TEST_CASE("gpu_check passes right kernels and not wrong ones", "[gpu_check][stat][long]") {
    const ScratchFolder folder;
    const std::string pack = (folder / "pack").string(), gpu_check = pack + "/gpu_check";
    const Outcome packed = run_shell(OPAL_SOURCE_DIR "/scripts/gpu_check --opal " OPAL_BINARY " --pack " + pack);
    INFO(packed.out << packed.err);
    REQUIRE(packed.exit_code == 0);

    const std::string as_gpu = "LD_PRELOAD=" OPAL_POSING " OPAL_POSE=gpu ";
    check_table(run_shell(as_gpu + gpu_check), 0,
                {"selftest --quick              right", "picture of cbox_mis           right",
                 "picture of mixed_room         right", "M paths/s", "Mrays/s", "all is right"});

    const std::string sampled = "v3_mul(path->throughput, light_in)";
    const Mutant too_bright = {"sampled light 2 % too bright", "integrators/steps.cl", sampled,
                               "v3_scale(" + sampled + ", (real)(1.02f))"};
    check_table(run_shell(as_gpu + gpu_check + " --opal " + opal_with(folder, write_kernels(folder, too_bright))), 1,
                {"selftest --quick              WRONG", "floor and light, p, lanes 1, precise",
                 "picture of cbox_mis           WRONG", "NOT all is right"});
}
