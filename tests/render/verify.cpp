// `opal verify` as its users meet it: it accepts right kernels, and finds biases that were planted in wrong ones.
#include "base/exit_code.h"
#include "base/json.h"
#include "read/nori/load.h"
#include "scene/options.h"
#include "strategies/combinations.h"
#include "support/mutants.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <regex>

using namespace opal;
using namespace opal::test;

namespace {

// A wall lit by a large light behind the camera: little noise, whatever the strategy.
const char *const scene_text = R"(<scene>
  <integrator type="path_mis"><integer name="maxDepth" value="2"/></integrator>
  <sampler type="independent"><integer name="sampleCount" value="4"/></sampler>
  <camera type="perspective"><integer name="width" value="24"/><integer name="height" value="12"/></camera>
  <mesh type="parallelogram">
    <point name="origin" value="5 -5 3"/><vector name="u" value="-10 0 0"/><vector name="v" value="0 10 0"/>
    <bsdf type="diffuse"><color name="albedo" value="0.5 0.5 0.5"/></bsdf>
  </mesh>
  <mesh type="parallelogram">
    <point name="origin" value="-5 -5 -1"/><vector name="u" value="10 0 0"/><vector name="v" value="0 10 0"/>
    <bsdf type="diffuse"><color name="albedo" value="0 0 0"/></bsdf>
    <emitter type="area"><color name="radiance" value="1 2 3"/></emitter>
  </mesh>
</scene>
)";

struct SceneFolder {
    ScratchFolder scratch;
    std::string scene = scratch.write("wall.xml", scene_text).string();
    Outcome verify(const std::string &arguments) const {
        return run_shell("cd " + scratch.path().string() + " && " + OPAL_BINARY + " verify " + scene +
                         " --json out.json " + arguments);
    }
    nlohmann::json report() const { return nlohmann::json::parse(read_text(scratch / "out.json")); }
    std::string wrong_kernels(const Mutant &mutant) const { return " --cl-dir " + write_kernels(scratch, mutant); }
};

SceneDescription load(const SceneFolder &folder, const std::string &integrator) {
    SceneDescription scene = load_scene(folder.scene);
    override_strategy(scene.strategy, {{"integrator", integrator}, {"max-depth", "none"}});
    return scene;
}

} // namespace

TEST_CASE("The time left that verify tells is never more than its budget", "[verify]") {
    const SceneFolder folder;
    const Outcome outcome = folder.verify("--budget 4s --strategies 'lighting=mis;lighting=emitter'");
    INFO(outcome.err);
    static const std::regex told("verify +\\d+ %  ([0-9.]+) s left");
    std::vector<double> left;
    for (std::sregex_iterator i(outcome.err.begin(), outcome.err.end(), told), end; i != end; ++i)
        left.push_back(std::stod((*i)[1]));
    REQUIRE(left.size() >= 1);
    for (double seconds : left)
        CHECK(seconds < 4);
}

TEST_CASE("With --vary each value is verified, and one that disagrees decides the exit code", "[verify][stat]") {
    SceneFolder folder;
    std::string text = scene_text;
    text.replace(text.find("0.5 0.5 0.5"), 11, "$a $a $a");
    folder.scene = folder.scratch.write("wall.xml", text);
    const std::string how = "--vary a=0.3,0.6 --budget 4s --strategies 'lighting=mis;lighting=emitter'";
    const Outcome right = folder.verify(how);
    INFO(right.out << right.err);
    CHECK(right.exit_code == exit_done);
    const nlohmann::json report = folder.report();
    CHECK(report["vary"] == "a");
    CHECK(report["agree"] == true);
    REQUIRE(report["values"].size() == 2);
    CHECK(report["values"][1]["value"] == "0.6");
    CHECK(report["values"][1]["definitions"]["a"] == "0.6");
    CHECK_FALSE(std::filesystem::exists(folder.scratch / "verify_wall"));
    for (const char *value : {"0.3", "0.6"})
        CHECK_THAT(right.out, Catch::Matches(fmt::format("(.|\n)*\n{} +agree +[0-9.e-]+ +0 of 1, 0\n(.|\n)*", value)));

    // A wall that reflects nothing does not show the light samples' bias.
    const Mutant mutant{"light samples 50 % too bright", "integrators/steps.cl",
                        "light.radiance), bsdf.cosine * inverse_pdf",
                        "light.radiance), R(1.5) * bsdf.cosine * inverse_pdf"};
    const Outcome wrong = folder.verify("--vary a=0.6,0 --budget 4s --strategies 'lighting=bsdf;lighting=emitter'" +
                                        folder.wrong_kernels(mutant));
    INFO(wrong.out << wrong.err);
    CHECK(wrong.exit_code == exit_check_failed);
    CHECK(folder.report()["agree"] == false);
    CHECK(folder.report()["values"][0]["agree"] == false);
    CHECK(folder.report()["values"][1]["agree"] == true);
    CHECK_THAT(wrong.out, Catch::Contains("\n0.6                   DISAGREE"));
    CHECK(std::filesystem::exists(folder.scratch / "verify_wall/a=0.6/verify.json"));
    CHECK_FALSE(std::filesystem::exists(folder.scratch / "verify_wall/a=0"));
}

TEST_CASE("All sensible strategies of a right renderer agree", "[verify][stat]") {
    const SceneFolder folder;
    const Outcome outcome = folder.verify("--budget 20s");
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Catch::Contains("strategies agree") && Catch::Contains("Power: with 90 %"));
    const auto report = folder.report();
    CHECK(report["agree"] == true);
    CHECK(report["strategies"].size() >= 5);
    CHECK(report["pairs"].size() == report["strategies"].size() * (report["strategies"].size() - 1) / 2);
    double least_spp = INFINITY; // a busy machine renders few samples in that time
    for (const auto &strategy : report["strategies"])
        least_spp = std::min(least_spp, strategy["spp"].get<double>());
    CHECK(report["detectable_bias"].get<double>() < 0.5 / std::sqrt(least_spp)); // 2 % with 625 samples
    CHECK_FALSE(std::filesystem::exists(folder.scratch / "verify_wall"));
}

TEST_CASE("A bias of 2 % in one strategy is found, and the strategy is named", "[verify][stat]") {
    const SceneFolder folder;
    const Mutant mutant{"uniform sampling 2 % too bright", "bsdfs/diffuse.cl", "by_cosine ? (real)(1) : 2 * wo.z",
                        "by_cosine ? (real)(1) : R(2.04) * wo.z"};
    const Outcome outcome =
        folder.verify("--budget 20s --strategies 'lighting=bsdf,hemisphere=cosine; lighting=bsdf,hemisphere=uniform; "
                      "lighting=emitter'" +
                      folder.wrong_kernels(mutant));
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == exit_check_failed);
    CHECK_THAT(outcome.out, Catch::Contains("DISAGREE: 2 of 3 pairs") &&
                                Catch::Contains("lighting=bsdf,hemisphere=uniform stands alone: 2 of its 2 pairs"));
    CHECK(folder.report()["agree"] == false);
    for (const char *file : {"image.exr", "reference.exr", "z.png", "strategy_3.exr", "verify.json"})
        CHECK(std::filesystem::exists(folder.scratch / "verify_wall" / file));
}

TEST_CASE("A bias of 2 % of light sampling is found by the strategies chosen by default", "[verify][stat]") {
    const SceneFolder folder;
    const Mutant mutant{"light samples 2 % too bright", "integrators/steps.cl",
                        "light.radiance), bsdf.cosine * inverse_pdf",
                        "light.radiance), R(1.02) * bsdf.cosine * inverse_pdf"};
    const Outcome outcome = folder.verify("--budget 30s" + folder.wrong_kernels(mutant));
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == exit_check_failed);
    CHECK_THAT(folder.report()["suspect"].get<std::string>(), Catch::Contains("lighting="));
}

TEST_CASE("Strategies that do not exist or make no sense are refused before rendering", "[verify]") {
    const SceneFolder folder;
    const auto refused = [&](const std::string &strategies, const std::string &reason) {
        const Outcome outcome = folder.verify("--strategies '" + strategies + "'");
        INFO(strategies << "\n" << outcome.err);
        CHECK(outcome.exit_code == exit_usage);
        CHECK_THAT(outcome.err, Catch::Contains(reason));
        CHECK_FALSE(std::filesystem::exists(folder.scratch / "out.json"));
    };
    refused("lighting=mis", "nothing to hold against each other: 1 strategy");
    refused("lighting=mis;lighting=emiter",
            "strategy 'lighting=emiter': unknown lighting 'emiter'; did you mean 'emitter'?");
    refused("lighting=mis;lihgting=bsdf", "unknown strategy option 'lihgting'");
    refused("lighting=mis;mis=one-sample", "makes no sense");
    refused("lighting=mis;lighting", "'lighting' is not AXIS=CHOICE");
    refused("lighting=mis;lighting=mis,mis=balance", "the same as 'lighting=mis'");
}

TEST_CASE("The covering set holds every pair of choices that makes sense, once", "[verify]") {
    const SceneFolder folder;
    const SceneDescription scene = load(folder, "path_mis");
    const auto all = sensible_strategies(scene, 100000), few = sensible_strategies(scene);
    REQUIRE(all.size() > 30);
    CHECK(few.size() < 16);
    CHECK(few.front().strategy.choices == all.front().strategy.choices);
    for (const NamedStrategy &one : all)
        for (int a = 0; a < AXIS_COUNT; a++)
            for (int b = 0; b < a; b++)
                CHECK(std::any_of(few.begin(), few.end(), [&](const NamedStrategy &s) {
                    return s.strategy[a] == one.strategy[a] && s.strategy[b] == one.strategy[b];
                }));
    for (const NamedStrategy &s : all) {
        CHECK(s.strategy[AXIS_rr] != CHOICE_rr_off);            // paths without end
        CHECK(s.strategy[AXIS_rr] != CHOICE_rr_throughput_eta); // nothing refracts
        CHECK(s.strategy[AXIS_mis] != CHOICE_mis_one_sample);
    }
}

TEST_CASE("Each integrator varies what it asks", "[verify]") {
    const SceneFolder folder;
    CHECK(sensible_strategies(load(folder, "ao"), 100).size() == 2 * 3);  // hemisphere, sampler
    CHECK(sensible_strategies(load(folder, "normals"), 100).size() == 3); // sampler
    CHECK(sensible_strategies(load(folder, "whitted"), 100).size() == 3); // sampler: one emitter, no triangles
    // lighting bsdf (3 hemispheres), emitter, mis (its heuristics x 3 hemispheres), each with 3 samplers
    const size_t heuristics = axes()[AXIS_mis].choices.size();
    CHECK(sensible_strategies(load(folder, "direct_lighting"), 100).size() == 3 * (3 + 1 + 3 * heuristics));
    SceneDescription with_point = load(folder, "direct_lighting");
    with_point.lights.push_back({emitter_point{{0, 0, 0}, {1, 1, 1}}, {}});
    for (const NamedStrategy &s : sensible_strategies(with_point, 100))
        CHECK(s.strategy[AXIS_lighting] != CHOICE_lighting_bsdf);
}
