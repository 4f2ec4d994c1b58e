// `opal selftest`: right on this device, and a wrong, crashing or hanging driver is reported as such.
#include "selftest/selftest.h"
#include "base/exit_code.h"
#include "base/json.h"
#include "base/table.h"
#include "support/device.h"
#include "support/mutants.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace opal;
using namespace opal::test;

namespace {

// With a time limit that busy machines keep, too, unless the arguments have another one.
Outcome selftest(const std::string &arguments) {
    const std::string limit = arguments.find("--time-limit") == std::string::npos ? " --time-limit 1000" : "";
    return run_shell(std::string(OPAL_BINARY) + " selftest --device " + wanted_device() + limit + " " + arguments);
}

// selftest with wrong kernels, as if the driver had compiled the right ones wrongly.
Outcome selftest_of(const Mutant &mutant, const std::string &group) {
    const ScratchFolder folder;
    return selftest("--group " + group + " --cl-dir " + write_kernels(folder, mutant));
}

} // namespace

TEST_CASE("This device passes, at both widths and with both kinds of math", "[selftest][stat]") {
    const ScratchFolder folder;
    const Outcome outcome = selftest("--json " + (folder / "out.json").string());
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    const auto json = nlohmann::json::parse(read_text(folder / "out.json"));
    CHECK(json.at("checks").size() >= 60);
    for (const auto &check : json.at("checks"))
        CHECK(check.at("passed") == true);
}

TEST_CASE("What computes wrong is found", "[selftest][stat]") {
    struct WrongKernel {
        const char *group, *file, *from, *to;
        const char *check; // that fails
        bool one_lane = false;
    };
    const WrongKernel kernels[] = {
        {"basics", "core/math.cl", "R(8.3333333333333333e-03)", "R(8.3233333333333333e-03)", "error of sin_2pi"},
        {"basics", "core/rng.cl", "0x53a22864u", "0x53a22865u", "Sobol"},
        {"warps", "core/warp.cl", "sqrt(u.x * (2 - u.x))", "sqrt(u.x)", "warps: samples"},
        {"bsdfs", "bsdfs/microfacet.cl", "(4 * fabs(v3_dot(h, wo)));", "(4.1f * fabs(v3_dot(h, wo)));",
         "BSDFs: samples"},
        {"bsdfs", "bsdfs/dielectric.cl", "reflects ? fresnel : 1 - fresnel", "reflects ? fresnel : 1",
         "mirror, dielectric"},
        {"lights", "emitters/mesh.cl", "folded ? 1 - u.x", "folded ? u.x", "lights: directions"},
        {"lights", "emitters/point.cl", "square(inverse_distance)), (real)(1)",
         "square(inverse_distance)), (real)(0.5f)", "lights: samples of delta lights"},
        {"lights", "emitters/point.cl", "v3_scale(color, square", "v3_scale(color, R(1.1) * square", "lights: power"},
        {"rays", "trace/one_lane/walk.cl", "near_x = inverse.x < 0", "near_x = inverse.x > 0", "tree: hits", true},
        {"images", "integrators/steps.cl", "bsdf.cosine * inverse_pdf", "inverse_pdf", "furnace"},
    };
    for (const WrongKernel &kernel : kernels) {
        INFO(kernel.file << ": " << kernel.to);
        const Sources sources = mutated(Sources::embedded(), {kernel.check, kernel.file, kernel.from, kernel.to});
        SelftestOptions options;
        options.build.lanes = kernel.one_lane ? 1 : device().info.native_lanes;
        options.sources = &sources;
        const Findings findings = find_row(check_groups(), "group", kernel.group).run(device(), options);
        CHECK(std::any_of(findings.begin(), findings.end(),
                          [&](const Finding &f) { return f.check.starts_with(kernel.check) && !f.passed; }));
    }
}

TEST_CASE("The table marks what failed, and the exit code says so", "[selftest]") {
    const Outcome outcome = selftest_of({"Sobol", "core/rng.cl", "0x53a22864u", "0x53a22865u"}, "basics");
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == opal::exit_check_failed);
    const size_t line = outcome.out.find("Sobol numbers, wrong");
    REQUIRE(line != std::string::npos);
    const std::string row = outcome.out.substr(line, outcome.out.find('\n', line) - line);
    CHECK(size_t(std::count(row.begin(), row.end(), '!')) == 2 * tested_lanes().size()); // precise and fast
    CHECK_THAT(outcome.out, Catch::Contains("FAILED: "));
}

TEST_CASE("A crash, a hang and kernels that do not build are told", "[selftest]") {
    const char *const output = "columns[column * stride + base + lane] = (float)lanes[lane];";
    const Outcome crash = selftest_of({"crash", "kernels/sample_columns.cl", output,
                                       "*(volatile global float *)(8 + get_global_id(0)) = (float)lanes[lane];"},
                                      "warps");
    CHECK(crash.exit_code == opal::exit_check_failed);
    CHECK_THAT(crash.out, Catch::Contains("warps at 1 precise: crashed (Segmentation fault)"));
    const Outcome broken = selftest_of({"broken", "kernels/sample_columns.cl", output, "nothing;"}, "warps");
    CHECK(broken.exit_code == opal::exit_check_failed);
    CHECK_THAT(broken.out, Catch::Contains("the kernels do not build"));
    const ScratchFolder folder;
    const Outcome late = selftest("--group warps --time-limit 0.05");
    CHECK(late.exit_code == opal::exit_check_failed);
    CHECK_THAT(late.out, Catch::Contains("did not end within 0.05 s"));
}
