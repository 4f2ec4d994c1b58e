// `opal warp`: right kernels are accepted, wrong ones rejected, and the picture is written.
#include "base/exit_code.h"
#include "support/mutants.h"

#include <catch2/catch.hpp>

using namespace opal::test;

namespace {

Outcome warp(const std::string &arguments) {
    return run_shell(std::string(OPAL_BINARY) + " warp --samples 3e5 --significance 1e-5 --device " + wanted_device() +
                     " " + arguments);
}

} // namespace

TEST_CASE("Every target of the list is accepted", "[warp_command][stat]") {
    const Outcome list = warp("--list");
    REQUIRE(list.exit_code == 0);
    std::istringstream lines(list.out);
    int targets = 0;
    for (std::string line; std::getline(lines, line); targets++) {
        const Outcome outcome = warp(line.substr(0, line.find(' ')));
        INFO(outcome.out << outcome.err);
        CHECK(outcome.exit_code == 0);
        CHECK(line.find_last_of(' ') > 21); // says what it is
    }
    CHECK(warp("square_to_cosine_hemisphere").exit_code == 0); // Nori's name
    CHECK(targets >= 13);
}

TEST_CASE("Lobes are accepted at grazing incidence, narrow and wide, at one lane", "[warp_command][stat]") {
    for (const char *arguments :
         {"bsdf:microfacet --alpha 0.02 --theta 89.9", "bsdf:microfacet --alpha 1 --kd 0 --theta 80 --phi 200",
          "bsdf:phong --n 2000 --pd 0 --theta 70", "beckmann --alpha 0.003", "phong_lobe --n 1e5",
          "light:many --triangle-choice uniform --emitter-choice power"}) {
        const Outcome outcome = warp(std::string(arguments) + " --lanes 1");
        INFO(arguments << "\n" << outcome.out << outcome.err);
        CHECK(outcome.exit_code == 0);
    }
}

TEST_CASE("A wrong density is rejected", "[warp_command][stat]") {
    const ScratchFolder folder;
    const auto warp_of = [&](const Mutant &mutant, const std::string &arguments) {
        return warp(arguments + " --cl-dir " + write_kernels(folder, mutant)).exit_code;
    };
    const Mutant hemisphere = {
        "cosine hemisphere without the cosine", "core/warp.cl",
        "v3 square_to_cosine_hemisphere(v2 u) { return direction_of(sqrt(1 - u.x), sqrt(u.x)",
        "v3 square_to_cosine_hemisphere(v2 u) { return direction_of(1 - u.x, sqrt(u.x * (2 - u.x))"};
    const Mutant alias = {"half of all rows keep their index", "emitters/alias_table.cl",
                          "unit_real((u).y) < GATHER(real, (scene)->table, (first) + row_, .accept)",
                          "(u).y < 0x80000000u"};
    CHECK(warp_of(hemisphere, "cosine_hemisphere") == opal::exit_check_failed);
    CHECK(warp_of(alias, "light:many --emitter-choice power") == opal::exit_check_failed);
    CHECK(warp_of(alias, "uniform_disk") == 0);
}

TEST_CASE("The plot is a PNG; what does not exist is named", "[warp_command]") {
    const ScratchFolder folder;
    CHECK(warp("tent --plot " + (folder / "tent.png").string()).exit_code == 0);
    CHECK_THAT(read_text(folder / "tent.png"), Catch::StartsWith("\x89PNG"));
    CHECK_THAT(warp("beckman").err, Catch::Contains("did you mean 'beckmann'"));
    CHECK_THAT(warp("tent --alpha 0.1").err, Catch::Contains("tent has no parameter --alpha"));
    CHECK_THAT(warp("bsdf:phong --alpha 0.1").err, Catch::Contains("alpha"));
}
