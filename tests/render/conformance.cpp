// `opal test`: scenes and BSDFs whose means are known in closed form or by quadrature, and kernels that are wrong.
#include "base/exit_code.h"
#include "base/json.h"
#include "support/mutants.h"

#include <catch2/catch.hpp>

using namespace opal::test;

namespace {

const std::filesystem::path cases = OPAL_SOURCE_DIR "/tests/cases/conformance";

Outcome run_tests(const std::string &arguments) {
    return run_shell(std::string(OPAL_BINARY) + " test --device " + wanted_device() + " " + arguments);
}

} // namespace

TEST_CASE("All cases of tests/cases/conformance pass", "[conformance][stat]") {
    std::string files;
    for (const auto &entry : std::filesystem::directory_iterator(cases))
        if (entry.path().extension() == ".xml")
            files += entry.path().string() + " ";
    REQUIRE_FALSE(files.empty());
    // By the kernel for all scenes, and by kernels of each scene.
    for (const char *options : {"--significance 1e-4", "--significance 1e-4 --lanes 1 --seed 7 --specialise on"}) {
        const Outcome outcome = run_tests(files + options);
        INFO(outcome.out << outcome.err);
        CHECK(outcome.exit_code == 0);
    }
}

TEST_CASE("A wrong reference is rejected, and the JSON says so", "[conformance]") {
    const ScratchFolder folder;
    const std::string test =
        folder.write("wrong.xml", "<test type='ttest'><string name='angles' value='0 30'/>"
                                  "<string name='references' value='0.5 0.51'/><bsdf type='diffuse'/></test>");
    const Outcome outcome = run_tests(test + " --json " + (folder / "out.json").string());
    CHECK(outcome.exit_code == opal::exit_check_failed);
    const auto json = nlohmann::json::parse(read_text(folder / "out.json"));
    const auto &results = json.at("tests").at(0).at("cases");
    CHECK(results.at(0).at("passed") == true);
    CHECK(results.at(1).at("passed") == false);
    CHECK(results.at(1).at("p_value").get<double>() < 1e-3);
}

TEST_CASE("--samples and --significance override the file", "[conformance]") {
    const std::string file = (cases / "furnace.xml").string();
    const Outcome outcome = run_tests(file + " --samples 2000 --significance 0.00123");
    CHECK_THAT(outcome.out, Catch::Contains("level 0.00123"));
}

TEST_CASE("Wrong kernels are rejected", "[conformance][stat]") {
    struct WrongKernel {
        const char *file, *from, *to, *test;
        unsigned samples;
        int exit_code = opal::exit_check_failed;
    };
    const WrongKernel kernels[] = {
        {"bsdfs/diffuse.cl", "2 * wo.z", "(wo.z < 2 ? 2 * wo.z : (real)(NAN))", "triangle_light.xml", 100000,
         0},                                                                 // the same
        {"bsdfs/diffuse.cl", "2 * wo.z", "1", "triangle_light.xml", 400000}, // a dropped cosine
        {"bsdfs/diffuse.cl", "2 * wo.z", "(u.x < R(0.999) ? 2 * wo.z : (real)(NAN))", "microfacet_albedo.xml", 100000},
        {"emitters/mesh.cl", "    return color;", "    return v3_all((real)(NAN));", "furnace.xml", 1000},
        {"emitters/area_light.cl", "square(s->t) /", "s->t /", "furnace.xml", 100000}, // MIS mixes measures
        {"emitters/constant.cl", "color, 1 / square", "color, 2 / square", "sky.xml", 1000},
        {"emitters/envmap.cl", "active ? sine / density", "active ? 1 / density", "environment_map.xml", 100000},
        {"emitters/dispatch.cl", "ray.d = v3_pick(light.infinite, light.d, d);", "", "spots_and_lenses.xml", 1000},
        {"emitters/spot.cl", "falloff * square(inverse_distance)", "falloff * inverse_distance", "spots_and_lenses.xml",
         1000},
        {"core/warp.cl", "R(0.5) * log1p", "R(0.52) * log1p", "chi2_bsdfs.xml", 200000}, // another exponent
        {"bsdfs/phong.cl", "base_chance * square_to_cosine_hemisphere_pdf(wo) +",
         "R(1.02) * base_chance * square_to_cosine_hemisphere_pdf(wo) +", "chi2_bsdfs.xml", 200000},
    };
    for (const WrongKernel &m : kernels) {
        const ScratchFolder folder;
        const Outcome outcome =
            run_tests((cases / m.test).string() + " --significance 1e-4 --samples " + std::to_string(m.samples) +
                      " --cl-dir " + write_kernels(folder, {m.to, m.file, m.from, m.to}));
        INFO(m.file << ": " << m.to << "\n" << outcome.out << outcome.err);
        CHECK(outcome.exit_code == m.exit_code);
        CHECK_THAT(outcome.err, !Catch::Contains("error:"));
    }
}
