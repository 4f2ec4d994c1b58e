// `opal selftest`: right on this device, and a wrong, crashing or hanging driver is reported as such.
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cstdlib>

using namespace opal::test;

namespace {

Outcome selftest(const std::string &arguments) {
    const char *wanted = std::getenv("OPAL_TEST_DEVICE");
    return run_shell(std::string(OPAL_BINARY) + " selftest --device " + (wanted ? wanted : "cpu") + " " + arguments);
}

// The kernels as a driver would run them that does `to` where `from` is written.
Outcome selftest_of_mutant(const std::string &group, const std::string &file, const std::string &from,
                           const std::string &to) {
    const ScratchFolder folder;
    std::filesystem::copy(OPAL_SOURCE_DIR "/cl", folder / "cl", std::filesystem::copy_options::recursive);
    std::string text = read_text(folder / ("cl/" + file));
    const size_t place = text.find(from);
    REQUIRE(place != std::string::npos);
    folder.write("cl/" + file, text.replace(place, from.size(), to));
    return selftest("--group " + group + " --time-limit 60 --cl-dir " + (folder / "cl").string());
}

} // namespace

TEST_CASE("This device passes, at both widths and with both kinds of math", "[selftest]") {
    const ScratchFolder folder;
    const Outcome outcome = selftest("--json " + (folder / "out.json").string());
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder / "out.json"));
    CHECK(json.at("checks").size() >= 60);
    for (const auto &check : json.at("checks"))
        CHECK(check.at("passed") == true);
}

TEST_CASE("What computes wrong is found", "[selftest]") {
    struct Mutant {
        const char *group, *file, *from, *to, *found;
    };
    const Mutant mutants[] = {
        {"basics", "core/math.cl", "R(8.3333333333333333e-03)", "R(8.3233333333333333e-03)", "sin_2pi"},
        {"basics", "core/rng.cl", "0x53a22864u", "0x53a22865u", "Sobol"},
        {"warps", "core/warp.cl", "sqrt(u.x * (2 - u.x))", "sqrt(u.x)", "warps: samples"},
        {"bsdfs", "bsdfs/microfacet.cl", "(4 * fabs(v3_dot(h, wo)));", "(4.1f * fabs(v3_dot(h, wo)));",
         "BSDFs: samples"},
        {"bsdfs", "bsdfs/dielectric.cl", "square(boundary.inverse_eta)", "boundary.inverse_eta", "mirror, dielectric"},
        {"lights", "emitters/mesh.cl", "folded ? 1 - point.x", "folded ? point.x", "lights: points"},
        {"rays", "trace/one_lane/walk.cl", "near_x = inverse.x < 0", "near_x = inverse.x > 0", "tree: hits"},
        {"images", "integrators/steps.cl", "wo.z * inverse_pdf", "inverse_pdf", "furnace"},
    };
    for (const Mutant &m : mutants) {
        const Outcome outcome = selftest_of_mutant(m.group, m.file, m.from, m.to);
        INFO(m.file << "\n" << outcome.out << outcome.err);
        CHECK(outcome.exit_code == 1);
        const size_t line = outcome.out.find(m.found);
        REQUIRE(line != std::string::npos);
        CHECK(outcome.out.substr(line, outcome.out.find('\n', line) - line).find('!') != std::string::npos);
    }
}

TEST_CASE("A crash, a hang and kernels that do not build are told", "[selftest]") {
    const char *const output = "columns[column * stride + base + lane] = (float)lanes[lane];";
    const Outcome crash = selftest_of_mutant("warps", "kernels/columns.cl", output,
                                             "*(volatile global float *)(8 + get_global_id(0)) = (float)lanes[lane];");
    CHECK(crash.exit_code == 1);
    CHECK_THAT(crash.out, Catch::Contains("warps at 1 precise: crashed (Segmentation fault)"));
    const Outcome broken = selftest_of_mutant("warps", "kernels/columns.cl", output, "nothing;");
    CHECK(broken.exit_code == 1);
    CHECK_THAT(broken.out, Catch::Contains("the kernels do not build"));
    const ScratchFolder folder;
    const Outcome late = selftest("--group warps --time-limit 0.05");
    CHECK(late.exit_code == 1);
    CHECK_THAT(late.out, Catch::Contains("did not end within 0.05 s"));
}
