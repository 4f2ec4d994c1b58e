// `opal warp`: right kernels are accepted, wrong ones rejected, and the picture is written.
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <cstdlib>

using namespace opal::test;

namespace {

Outcome warp(const std::string &arguments) {
    const char *wanted = std::getenv("OPAL_TEST_DEVICE");
    return run_shell(std::string(OPAL_BINARY) + " warp --samples 3e5 --significance 1e-5 --device " +
                     (wanted ? wanted : "cpu") + " " + arguments);
}

} // namespace

TEST_CASE("Every target of the list is accepted", "[warp_command]") {
    const Outcome list = warp("--list");
    REQUIRE(list.exit_code == 0);
    std::istringstream lines(list.out);
    int targets = 0;
    for (std::string line; std::getline(lines, line); targets++) {
        const Outcome outcome = warp(line.substr(0, line.find(' ')));
        INFO(outcome.out << outcome.err);
        CHECK(outcome.exit_code == 0);
    }
    CHECK(targets >= 13);
}

TEST_CASE("Lobes are accepted at grazing incidence, narrow and wide, at one lane", "[warp_command]") {
    for (const char *arguments :
         {"bsdf:microfacet --alpha 0.02 --theta 89.9", "bsdf:microfacet --alpha 1 --kd 0 --theta 80 --phi 200",
          "bsdf:phong --n 2000 --pd 0 --theta 70", "beckmann --alpha 0.003", "phong_lobe --n 1e5",
          "light:many --triangle-choice uniform --emitter-choice power"}) {
        const Outcome outcome = warp(std::string(arguments) + " --lanes 1");
        INFO(arguments << "\n" << outcome.out << outcome.err);
        CHECK(outcome.exit_code == 0);
    }
}

TEST_CASE("A wrong density is rejected", "[warp_command]") {
    const ScratchFolder folder;
    std::filesystem::copy(OPAL_SOURCE_DIR "/cl", folder / "cl", std::filesystem::copy_options::recursive);
    const auto replace = [&](const std::string &file, const std::string &from, const std::string &to) {
        std::string text = read_text(folder / ("cl/" + file));
        const size_t place = text.find(from);
        REQUIRE(place != std::string::npos);
        folder.write("cl/" + file, text.replace(place, from.size(), to));
    };
    replace("core/warp.cl", "v3 square_to_cosine_hemisphere(v2 u) { return direction_of(sqrt(1 - u.x), sqrt(u.x)",
            "v3 square_to_cosine_hemisphere(v2 u) { return direction_of(1 - u.x, sqrt(u.x * (2 - u.x))");
    replace("emitters/interface.cl", "unit_real((u).y) < GATHER(real, (scene)->table, (first) + row_, .accept)",
            "(u).y < 0x80000000u");
    const std::string mutated = " --cl-dir " + (folder / "cl").string();
    CHECK(warp("cosine_hemisphere" + mutated).exit_code == 1);
    CHECK(warp("light:many --emitter-choice power" + mutated).exit_code == 1);
    CHECK(warp("uniform_disk" + mutated).exit_code == 0);
}

TEST_CASE("The plot is a PNG; what does not exist is named", "[warp_command]") {
    const ScratchFolder folder;
    CHECK(warp("tent --plot " + (folder / "tent.png").string()).exit_code == 0);
    CHECK_THAT(read_text(folder / "tent.png"), Catch::StartsWith("\x89PNG"));
    CHECK_THAT(warp("beckman").err, Catch::Contains("did you mean 'beckmann'"));
    CHECK_THAT(warp("tent --alpha 0.1").err, Catch::Contains("tent has no parameter --alpha"));
    CHECK_THAT(warp("bsdf:phong --alpha 0.1").err, Catch::Contains("alpha"));
}
