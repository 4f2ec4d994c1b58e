// `opal verify` on the scenes of scenes/: all strategies agree, and a bias of 2 % planted in one strategy of the
// Cornell box is found within a minute, on every seed.
#include "base/exit_code.h"
#include "base/json.h"
#include "support/mutants.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

const std::string light_hit = "v3_mul(path->throughput, light_met(scene, path, &s, on_surface, active))";
const std::string heuristic = "1 / (1 + (CHOSEN(scene, mis, power) ? ratio * ratio : ratio))";

const std::vector<Mutant> planted = {
    {"light samples", "integrators/steps.cl", "light.radiance), bsdf.cosine * inverse_pdf",
     "light.radiance), R(1.02) * bsdf.cosine * inverse_pdf"},
    {"uniform directions", "bsdfs/diffuse.cl", "by_cosine ? (real)(1) : 2 * wo.z",
     "by_cosine ? (real)(1) : R(2.04) * wo.z"},
    {"cosine directions", "bsdfs/diffuse.cl", "by_cosine ? (real)(1) : 2 * wo.z",
     "b.use_cosine ? (real)(R(1.02)) : 2 * wo.z"},
    {"the balance heuristic", "integrators/steps.cl", heuristic,
     "(CHOSEN(scene, mis, power) ? (real)(1) : (real)(R(1.02))) * " + heuristic},
    {"light hit without light samples", "integrators/path.cl", light_hit,
     "v3_scale(" + light_hit + ", CHOSEN(scene, lighting, bsdf) ? (real)(R(1.02)) : (real)(1))"},
};

} // namespace

TEST_CASE("All strategies agree on every scene of ours", "[verify_scenes][stat][long]") {
    const ScratchFolder folder;
    size_t scenes = 0;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(OPAL_SOURCE_DIR "/scenes")) {
        if (entry.path().extension() != ".xml" || entry.path().parent_path().filename() == "generated")
            continue;
        const Outcome outcome = run_shell(fmt::format("cd {} && {} verify {} --budget 30s --quiet",
                                                      folder.path().string(), OPAL_BINARY, entry.path().string()));
        INFO(entry.path() << "\n" << outcome.out << outcome.err);
        CHECK(outcome.exit_code == 0);
        scenes++;
    }
    CHECK(scenes >= 15);
}

TEST_CASE("verify finds every bias of 2 % planted in the Cornell box within a minute", "[verify_scenes][stat][long]") {
    const ScratchFolder folder;
    for (const Mutant &mutant : planted) {
        write_kernels(folder, mutant);
        for (const int seed : {100, 200, 300}) {
            const Outcome outcome = run_shell(fmt::format(
                "cd {} && {} verify {}/scenes/cbox_mis.xml --budget 60s --seed {} --quiet --cl-dir cl --json out.json",
                folder.path().string(), OPAL_BINARY, OPAL_SOURCE_DIR, seed));
            INFO(mutant.name << ", seed " << seed << "\n" << outcome.out << outcome.err);
            CHECK(outcome.exit_code == exit_check_failed);
            const auto report = nlohmann::json::parse(read_text(folder / "out.json"));
            CHECK(report["agree"] == false);
            CHECK(report["invalid_samples"] == 0);
        }
    }
}
