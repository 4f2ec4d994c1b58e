#include "scene/strategy.h"
#include "base/log.h"
#include "base/table.h"
#include "read/nori/load.h"
#include "scene/options.h"
#include "strategies/check.h"
#include "strategies/presets.h"
#include "support/error_of.h"

#include <catch2/catch.hpp>

#include <set>

using namespace opal;
using opal::test::error_of;

namespace {

std::string override_error(const std::string &name, const std::string &value) {
    Strategy strategy;
    return error_of([&] { override_strategy(strategy, {{name, value}}); });
}

Strategy overridden(const std::map<std::string, std::string> &overrides, Strategy strategy = {}) {
    override_strategy(strategy, overrides);
    return strategy;
}

SceneDescription lit_scene() {
    SceneDescription scene;
    Mesh light;
    light.shape = Parallelogram{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    light.radiance = Color{1, 1, 1};
    scene.meshes.push_back(light);
    return scene;
}

std::string check_error(SceneDescription scene, const std::map<std::string, std::string> &overrides) {
    override_strategy(scene.strategy, overrides);
    return error_of([&] { check_strategy(scene); });
}

} // namespace

TEST_CASE("axes and choices are the rows of the shared header, as typed", "[strategy]") {
    REQUIRE(axes().size() == AXIS_COUNT);
    CHECK(axes()[AXIS_emitter_choice].name == "emitter-choice");
    CHECK(axes()[AXIS_rr].choices.size() == 4);
    CHECK(axes()[AXIS_rr].choices[CHOICE_rr_throughput_eta].name == "throughput-eta");
    CHECK(axes()[AXIS_integrator].choices[CHOICE_integrator_direct_lighting].name == "direct-lighting");
    for (int axis = 0; axis < AXIS_COUNT; ++axis)
        for (size_t i = 0; i < axes()[axis].choices.size(); ++i) {
            CHECK(find_choice(axis, axes()[axis].choices[i].name) == int(i));
            CHECK_FALSE(axes()[axis].choices[i].help.empty());
        }
}

TEST_CASE("an integrator's row says which axes it reads, and its own name is a type in XML", "[strategy]") {
    REQUIRE(integrators().size() == axes()[AXIS_integrator].choices.size());
    for (const IntegratorTraits &integrator : integrators()) {
        INFO(integrator.name);
        CHECK(&integrators()[size_t(find_integrator(integrator.name).integrator)] == &integrator);
        CHECK(integrator.axes >> AXIS_COUNT == 0);
        CHECK(integrator.reads(AXIS_sampler));
        CHECK_FALSE(integrator.reads(AXIS_integrator));
        if (integrator.reads(AXIS_emitter_choice) || integrator.reads(AXIS_lighting))
            CHECK(integrator.has(OPAL_ASKS_LIGHTS));
    }
    CHECK(integrators()[CHOICE_integrator_path].reads(AXIS_rr));
    CHECK_FALSE(integrators()[CHOICE_integrator_direct_lighting].reads(AXIS_rr));
    CHECK_FALSE(integrators()[CHOICE_integrator_whitted].reads(AXIS_lighting));
}

TEST_CASE("a choice is found with either dash, or fails with the list", "[strategy]") {
    CHECK(find_choice(AXIS_mis, "one-sample") == CHOICE_mis_one_sample);
    CHECK(find_choice(AXIS_mis, "one_sample") == CHOICE_mis_one_sample);
    CHECK(error_of([] { find_choice(AXIS_mis, "powr"); }) ==
          "unknown mis 'powr'; did you mean 'power'? available: " + joined(names_of(axes()[AXIS_mis].choices)));
    CHECK(error_of([] { find_choice(AXIS_emitter_choice, "x"); }) ==
          "unknown emitter-choice 'x'; available: power, uniform");
}

TEST_CASE("a scene's integrator bears the name that was written, unless another is chosen", "[strategy]") {
    SceneDescription scene = lit_scene();
    scene.integrator_type = "path_mats";
    apply_integrator(scene.strategy, find_integrator("path_mats"));
    CHECK(integrator_name(scene) == "path_mats");
    override_strategy(scene.strategy, {{"lighting", "mis"}});
    CHECK(integrator_name(scene) == "path_mats");
    override_strategy(scene.strategy, {{"integrator", "ao"}});
    CHECK(integrator_name(scene) == "ao");
}

TEST_CASE("overrides set axes and numbers", "[strategy]") {
    Strategy s = overridden({{"lighting", "mis"},
                             {"mis", "power"},
                             {"hemisphere", "cosine"},
                             {"emitter-choice", "uniform"},
                             {"triangle-choice", "uniform"},
                             {"rr", "throughput-eta"},
                             {"sampler", "sobol"},
                             {"max-depth", "7"},
                             {"rr-depth", "5"},
                             {"rr-prob", "0.8"},
                             {"rr-max", "0.95"},
                             {"emitter-samples", "4"},
                             {"bsdf-samples", "2"},
                             {"math", "fast"},
                             {"lanes", "16"},
                             {"specialise", "off"}});
    CHECK(s[AXIS_lighting] == CHOICE_lighting_mis);
    CHECK(s[AXIS_mis] == CHOICE_mis_power);
    CHECK(s[AXIS_hemisphere] == CHOICE_hemisphere_cosine);
    CHECK(s[AXIS_emitter_choice] == CHOICE_emitter_choice_uniform);
    CHECK(s[AXIS_triangle_choice] == CHOICE_triangle_choice_uniform);
    CHECK(s[AXIS_rr] == CHOICE_rr_throughput_eta);
    CHECK(s[AXIS_sampler] == CHOICE_sampler_sobol);
    CHECK(s.max_depth == 7);
    CHECK(s.rr_depth == 5);
    CHECK(s.rr_prob == 0.8);
    CHECK(s.rr_max == 0.95);
    CHECK(s.emitter_samples == 4);
    CHECK(s.bsdf_samples == 2);
    CHECK(s.math == MathMode::fast);
    CHECK(s.lanes == 16);
    CHECK(s.specialise == Specialise::off);
    s = overridden({{"max-depth", "none"}, {"lanes", "auto"}, {"specialise", "on"}, {"math", "precise"}}, s);
    CHECK(s.max_depth == no_limit);
    CHECK(s.lanes == 0);
    CHECK(s.specialise == Specialise::on);
    CHECK(s.math == MathMode::precise);
}

TEST_CASE("every option that is listed can be set", "[strategy]") {
    std::map<std::string, std::string> values = {{"max-depth", "none"}, {"rr-depth", "3"},        {"rr-prob", "0.5"},
                                                 {"rr-max", "0.95"},    {"emitter-samples", "4"}, {"bsdf-samples", "2"},
                                                 {"math", "fast"},      {"lanes", "8"},           {"specialise", "on"}};
    size_t count = 0;
    for (const StrategyOption &option : strategy_options()) {
        bool is_number = values.contains(option.name);
        std::string value = is_number ? values[option.name] : "";
        for (const Axis &axis : axes())
            if (axis.name == option.name)
                value = axis.choices.back().name;
        CHECK(override_error(option.name, value).empty());
        CHECK_FALSE(override_error(option.name, "nonsense").empty());
        ++count;
    }
    CHECK(count == AXIS_COUNT - 1 + values.size());
}

TEST_CASE("bad overrides say what was possible", "[strategy]") {
    CHECK_THAT(
        override_error("lightning", "mis"),
        Catch::StartsWith("unknown strategy option 'lightning'; did you mean 'lighting'? available: integrator, "));
    CHECK(override_error("lighting", "nee") ==
          "unknown lighting 'nee'; did you mean 'emitter'? available: bsdf, emitter, mis");
    CHECK(override_error("max-depth", "0") == "max-depth ('none' for no limit) must be at least 1, not 0");
    CHECK(override_error("max-depth", "deep") == "'deep' is not an integer");
    CHECK(override_error("rr-depth", "-3") == "rr-depth must be at least 1, not -3");
    for (const char *bad : {"0", "1.1", "-1"})
        for (const char *option : {"rr-prob", "rr-max"})
            CHECK_THAT(override_error(option, bad), Catch::Contains("above 0 and at most 1, not " + std::string(bad)));
    CHECK(override_error("emitter-samples", "0") == "emitter-samples must be at least 1, not 0");
    CHECK(override_error("rr-prob", "nan") == "'nan' is not a finite number in single precision");
    CHECK(override_error("lanes", "2") == "unknown lanes '2'; available: auto, 1, 4, 8, 16");
    CHECK(override_error("math", "exact") == "unknown math 'exact'; available: precise, fast, double");
    CHECK_THAT(override_error("specialise", ""), Catch::Contains("available: auto, on, off"));
    CHECK_THAT(override_error("integrator", "path_mist"),
               Catch::StartsWith("unknown integrator 'path_mist'; did you mean 'path_mis'?"));
}

TEST_CASE("an integrator's name sets what it means, and explicit axes win", "[strategy]") {
    struct Row {
        const char *name;
        int integrator, lighting;
    };
    const int kept = CHOICE_lighting_mis;
    for (Row row :
         {Row{"normals", CHOICE_integrator_normals, kept}, Row{"ao", CHOICE_integrator_ao, kept},
          Row{"simple", CHOICE_integrator_simple, kept},
          Row{"whitted", CHOICE_integrator_whitted, CHOICE_lighting_emitter},
          Row{"direct_lighting", CHOICE_integrator_direct_lighting, kept},
          Row{"direct-lighting", CHOICE_integrator_direct_lighting, kept},
          Row{"path_tracer_recursive", CHOICE_integrator_path, kept}, Row{"path", CHOICE_integrator_path, kept},
          Row{"path_mats", CHOICE_integrator_path, CHOICE_lighting_bsdf},
          Row{"path_ems", CHOICE_integrator_path, CHOICE_lighting_emitter},
          Row{"path_mis", CHOICE_integrator_path, CHOICE_lighting_mis}}) {
        Strategy before;
        before[AXIS_lighting] = kept;
        Strategy s = overridden({{"integrator", row.name}}, before);
        INFO(row.name);
        CHECK(s[AXIS_integrator] == row.integrator);
        CHECK(s[AXIS_lighting] == row.lighting);
    }
    Strategy s =
        overridden({{"integrator", "path_mis"}, {"lighting", "bsdf"}, {"rr", "off"}, {"emitter-choice", "uniform"}});
    CHECK(s[AXIS_lighting] == CHOICE_lighting_bsdf);
    CHECK(s[AXIS_rr] == CHOICE_rr_off);
    CHECK(overridden({{"integrator", "path_mats"}})[AXIS_rr] == CHOICE_rr_throughput_eta);
}

TEST_CASE("a scene's choice that an override leaves without meaning falls back", "[strategy]") {
    Strategy one_sample;
    one_sample[AXIS_integrator] = CHOICE_integrator_direct_lighting;
    one_sample[AXIS_lighting] = CHOICE_lighting_mis;
    one_sample[AXIS_mis] = CHOICE_mis_one_sample;
    CHECK(overridden({{"lighting", "emitter"}}, one_sample)[AXIS_mis] == CHOICE_mis_balance);
    CHECK(overridden({{"integrator", "path_mis"}}, one_sample)[AXIS_mis] == CHOICE_mis_balance);
    CHECK(overridden({{"sampler", "sobol"}}, one_sample)[AXIS_mis] == CHOICE_mis_one_sample);
    CHECK(overridden({{"mis", "one-sample"}, {"lighting", "emitter"}}, one_sample)[AXIS_mis] == CHOICE_mis_one_sample);
    CHECK(overridden({{"integrator", "ao"}})[AXIS_hemisphere] == CHOICE_hemisphere_cosine);
    CHECK(overridden({{"integrator", "ao"}, {"hemisphere", "material"}})[AXIS_hemisphere] ==
          CHOICE_hemisphere_material);
}

TEST_CASE("nonsense is refused with its reason", "[strategy]") {
    SceneDescription scene = lit_scene();
    CHECK_THAT(check_error(scene, {{"integrator", "path_mis"}, {"mis", "one-sample"}}),
               Catch::StartsWith("mis one-sample without integrator direct_lighting makes no sense: "));
    CHECK_THAT(check_error(scene, {{"integrator", "direct_lighting"}, {"lighting", "bsdf"}, {"mis", "one-sample"}}),
               Catch::StartsWith("mis one-sample without lighting mis makes no sense: "));
    CHECK_THAT(check_error(scene, {{"integrator", "whitted"}, {"lighting", "mis"}}), Catch::Contains("whitted"));
    CHECK_THAT(check_error(scene, {{"integrator", "ao"}, {"hemisphere", "material"}}),
               Catch::Contains("asks no material"));
    CHECK_THAT(check_error(scene, {{"integrator", "simple"}}), Catch::Contains("gives it no light"));
    scene.strategy.rr_prob = 0;
    CHECK_THAT(check_error(scene, {{"integrator", "path_mis"}}), Catch::StartsWith("rr-prob 0"));
    scene.strategy.rr_prob = 0.5;
    scene.strategy.max_depth = 0;
    CHECK_THAT(check_error(scene, {{"integrator", "path_mis"}}), Catch::StartsWith("max-depth 0"));
}

TEST_CASE("point lights and BSDF sampling: refused alone, warned of beside area lights", "[strategy]") {
    SceneDescription scene;
    scene.lights.push_back({emitter_point{{0, 0, 0}, {1, 1, 1}}, {"a.xml", 3, 5}});
    CHECK_THAT(check_error(scene, {{"integrator", "path_mats"}}),
               Catch::StartsWith("lighting bsdf with point lights only"));
    CHECK(check_error(scene, {{"integrator", "path_mis"}}).empty());
    CHECK(check_error(scene, {{"integrator", "normals"}}).empty());
    SceneDescription both = lit_scene();
    both.lights = scene.lights;
    CHECK(check_error(both, {{"integrator", "path_mats"}}).empty());
    CHECK_THAT(warnings().back(), Catch::StartsWith("a.xml:3:5: lighting bsdf cannot hit point lights"));
    scene.lights = {{emitter_constant{}, {}}}; // rays that leave the scene hit it
    CHECK(check_error(scene, {{"integrator", "path_mats"}}).empty());
}

TEST_CASE("everything that means something passes", "[strategy]") {
    SceneDescription scene = lit_scene();
    int refused = 0, passed = 0;
    for (const char *integrator : {"path", "direct_lighting"})
        for (const Choice &lighting : axes()[AXIS_lighting].choices)
            for (const Choice &mis : axes()[AXIS_mis].choices)
                for (const Choice &hemisphere : axes()[AXIS_hemisphere].choices)
                    for (const Choice &rr : axes()[AXIS_rr].choices) {
                        std::string error = check_error(scene, {{"integrator", integrator},
                                                                {"lighting", lighting.name},
                                                                {"mis", mis.name},
                                                                {"hemisphere", hemisphere.name},
                                                                {"rr", rr.name},
                                                                {"max-depth", "9"}});
                        ++(error.empty() ? passed : refused);
                    }
    // one-sample: direct_lighting with lighting mis alone
    const int others = int(axes()[AXIS_mis].choices.size()) - 1;
    CHECK(passed == (3 * others + 3 * others + 1) * 3 * 4);
    CHECK(refused == (3 + 2) * 3 * 4);
}

TEST_CASE("endless paths are allowed with a warning", "[strategy]") {
    size_t before = warnings().size();
    CHECK(check_error(lit_scene(), {{"integrator", "path_mis"}, {"rr", "off"}}).empty());
    REQUIRE(warnings().size() == before + 1);
    CHECK_THAT(warnings().back(), Catch::StartsWith("rr off and no max-depth"));
    CHECK(check_error(lit_scene(), {{"integrator", "path_mis"}, {"rr", "off"}, {"max-depth", "5"}}).empty());
    CHECK(warnings().size() == before + 1);
}

TEST_CASE("the preset all leaves out what the scene does already", "[strategy]") {
    SceneDescription scene = lit_scene();
    override_strategy(scene.strategy, {{"integrator", "path_mis"}});
    const auto names = [&] {
        std::set<std::string> all;
        for (const Candidate &c : parse_strategies(scene, {"all"}, {}))
            all.insert(c.name);
        return all;
    };
    const std::string alike = "lighting=mis,mis=power,emitter-choice=uniform",
                      sobol = "lighting=mis,mis=power,sampler=sobol";
    const auto before = names();
    CHECK((before.contains(alike) && before.contains(sobol)));
    override_strategy(scene.strategy, {{"emitter-choice", "uniform"}, {"sampler", "sobol"}});
    const auto after = names();
    CHECK(after.size() == before.size() - 2);
    CHECK((!after.contains(alike) && !after.contains(sobol)));
}
