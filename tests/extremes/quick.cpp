// Single against double precision at the ends of what is promised, and the mutants that a row must see. The whole
// table: every_row.cpp.
#include "base/json.h"
#include "base/table.h"
#include "extremes/measure.h"
#include "support/device.h"
#include "support/mutants.h"
#include "support/scratch.h"
#include "support/seeds.h"

#include <algorithm>

using namespace opal;
using namespace opal::test;

namespace {

const extremes::StressRow &row(const std::string &name) { return find_row(extremes::stress_rows(), "row", name); }

extremes::StressSettings small(const Sources &sources = Sources::embedded()) {
    return {24, 64, test_seed(70), &sources};
}

bool doubles() {
    if (!device().info.fp64)
        WARN("the device has no double precision: nothing to hold single against");
    return device().info.fp64;
}

void require_kept(const extremes::StressResult &s) {
    INFO(s.row->name << ": " << extremes::breaking_point(s));
    CHECK(s.kept);
    for (const extremes::StressPoint &p : s.points) {
        INFO("at " << p.value);
        CHECK(p.invalid_single == 0);
        CHECK(p.invalid_oracle == 0);
    }
}

} // namespace

TEST_CASE("Single precision keeps what is promised at the ends of each range", "[quick]") {
    if (!doubles())
        return;
    for (const char *name :
         {"scale", "distance", "light-size", "sphere-scale", "sphere-distance", "sphere-furnace", "sphere-light",
          "alpha", "plastic-alpha", "principled", "phong", "edges", "numbers", "samplers", "depth", "height"})
        require_kept(run_stress(row(name), device(), small(), 100));
}

TEST_CASE("A million samples of 0.1 are 0.1 each", "[quick]") {
    if (!doubles())
        return;
    extremes::StressRow samples = row("samples");
    samples.values = {1, 1 << 20};
    samples.promised_to = 1 << 20;
    require_kept(run_stress(samples, device(), small(), 1));
}

TEST_CASE("What does not survive the extremes is seen by a row", "[quick]") {
    if (!doubles())
        return;
    struct Control {
        Mutant mutant;
        std::string row;
        double value;
    };
    for (const Control &c : std::vector<Control>{
             {{"an absolute epsilon", "surface.cl", "return RAY_OFFSET_ROUNDINGS * FLOAT_HALF_ULP * largest;",
               "return R(1e-3) + 0 * largest;"},
              "detail",
              1e-2},
             {{"naive 1 - cos^2", "core/warp.cl", "-expm1(log(u.x) / (n + 1))", "1 - exp(log(u.x) / (n + 1))"},
              "numbers",
              0.5},
             {{"a plain sum of the samples", "film/sums.cl", "r.lo = lo - (r.hi - hi);", "r.lo = 0;"},
              "samples",
              1 << 20}}) {
        extremes::StressRow one = row(c.row);
        one.values = {one.start, c.value};
        one.promised_from = std::min(one.start, c.value);
        one.promised_to = std::max(one.start, c.value);
        const Sources wrong = mutated(Sources::embedded(), c.mutant);
        INFO(c.mutant.name);
        const extremes::StressResult right = run_stress(one, device(), small(), 1),
                                     mutant = run_stress(one, device(), small(wrong), 1);
        INFO(extremes::breaking_point(right));
        CHECK(right.kept);
        CHECK_FALSE(mutant.kept);
    }
}

TEST_CASE("The command prints a table, and writes JSON and a plot", "[quick]") {
    if (!doubles())
        return;
    const ScratchFolder folder;
    const std::string opal =
        std::string(OPAL_BINARY) + " extremes --device " + wanted_device() + " --side 16 --spp 16 --row radiance ";
    const Outcome outcome =
        run_shell(opal + "--json " + (folder / "out.json").string() + " --plot " + (folder / "out.svg").string());
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Catch::Contains("radiance: ") && Catch::Contains("correct from"));
    const auto json = nlohmann::json::parse(read_text(folder / "out.json"));
    CHECK(json.at("rows").at(0).at("points").size() == row("radiance").values.size());
    CHECK_THAT(read_text(folder / "out.svg"),
               Catch::StartsWith("<svg") && Catch::Contains("radiance of a light") && Catch::EndsWith("</svg>\n"));
    CHECK_THAT(run_shell(opal + "--row size").err, Catch::Contains("available: "));
}
