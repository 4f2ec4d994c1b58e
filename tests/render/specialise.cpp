// --specialise auto: the general kernel renders where few paths are asked, and is one for all scenes.
#include "base/json.h"
#include "image/image.h"
#include "render/kernel_choice.h"
#include "support/mutants.h"

#include <catch2/catch.hpp>

using namespace opal;
using namespace opal::test;

namespace {

const std::string scenes = OPAL_SOURCE_DIR "/scenes/";

nlohmann::json rendered(const ScratchFolder &folder, const std::string &arguments) {
    const Outcome outcome = run_shell("cd " + folder.path().string() + " && " OPAL_BINARY " render --device cpu " +
                                      arguments + " --quiet --no-png -o a.exr --json -");
    INFO(arguments << "\n" << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return nlohmann::json::parse(outcome.out);
}

} // namespace

TEST_CASE("On a CPU few paths suit the general kernel, on a GPU none do", "[specialise]") {
    DeviceInfo cpu, gpu;
    cpu.type = "cpu";
    gpu.type = "gpu";
    cpu.compute_units = 2;
    CHECK(suits_general_kernel(cpu, paths_that_pay - 1));
    CHECK_FALSE(suits_general_kernel(cpu, paths_that_pay));
    CHECK_FALSE(suits_general_kernel(cpu, INFINITY));
    CHECK_FALSE(suits_general_kernel(gpu, 1));
    CHECK(suits_general_kernel(cpu, paths_in(cpu, 1)));
    CHECK_FALSE(suits_general_kernel(cpu, paths_in(cpu, 60)));
}

TEST_CASE("The kernel is chosen by what is asked, and stands in JSON and EXR", "[specialise]") {
    const ScratchFolder folder;
    const std::string box = scenes + "cbox_mis.xml --width 16 ";
    const auto kernel_of = [&](const std::string &options) {
        const nlohmann::json report = rendered(folder, box + options);
        CHECK(std::get<std::string>(read_exr(folder / "a.exr").metadata.at("opal.kernel")) == report["kernel"]);
        return report["kernel"].get<std::string>() + " by " + report["strategy"]["specialise"].get<std::string>();
    };
    CHECK(kernel_of("--spp 1") == "general by auto");
    CHECK(kernel_of("--spp 1 --time 1h") == "general by auto");
    CHECK(kernel_of("--time 10ms") == "general by auto");
    CHECK(kernel_of("--spp 200000 --time-limit 1ms") == "general by auto");
    CHECK(kernel_of("--target-error 50%") == "special by auto");
    CHECK(kernel_of("--target-error 50% --spp 64") == "general by auto");
    CHECK(kernel_of("--spp 1 --specialise on") == "special by on");
    CHECK(kernel_of("--target-error 50% --specialise off") == "general by off");
}

TEST_CASE("A scene that other scenes' general kernel cannot render has a kernel of its own from the start",
          "[specialise]") {
    const ScratchFolder folder;
    const auto kernel_of = [&](const std::string &arguments) {
        return rendered(folder, scenes + arguments)["kernel"].get<std::string>();
    };
    CHECK(kernel_of("preview.xml --width 8 --spp 1 -D material=gold") == "special"); // a texture, a metal
    CHECK(kernel_of("sky_over_model.xml --width 8 --spp 1") == "special");
    CHECK(kernel_of("spheres.xml --width 8 --spp 1") == "general");
    CHECK(kernel_of("mixed_room.xml --width 8 --spp 1") == "general");
    DeviceInfo cpu;
    cpu.type = "cpu";
    const auto suits = [&](const Bsdf &bsdf) {
        SceneDescription scene;
        scene.meshes.emplace_back().bsdf = bsdf;
        return suits_general_kernel(cpu, 1, scene);
    };
    CHECK(suits(bsdf_microfacet_record{}));
    CHECK_FALSE(suits(bsdf_plastic_record{}));
    Bsdf both = bsdf_twosided_record{};
    both.children = {Bsdf(bsdf_diffuse_record{})};
    CHECK(suits(both));
    both.children = {Bsdf(bsdf_roughplastic_record{})};
    CHECK_FALSE(suits(both));
}

TEST_CASE("After opal cache --warm no scene or strategy compiles a kernel for few paths", "[specialise]") {
    const ScratchFolder folder;
    const std::string cache = "POCL_CACHE_DIR=" + (folder / "cache").string() + " " OPAL_BINARY " ";
    const auto kernels = [&](const std::string &flags) {
        const Outcome outcome = run_shell(cache + "cache --device cpu --json - " + flags);
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        return nlohmann::json::parse(outcome.out)["bytes"].get<int>();
    };
    CHECK(kernels("") == 0);
    const int warm = kernels("--warm");
    CHECK(warm > 0);
    for (const char *scene : {"cbox_mis.xml", "mixed_room.xml", "many_lights.xml --lighting emitter --sampler sobol"}) {
        const Outcome outcome = run_shell("cd " + folder.path().string() + " && " + cache + "render --device cpu " +
                                          scenes + scene + " --width 16 --spp 1 --quiet -o a.exr");
        INFO(outcome.err);
        CHECK(outcome.exit_code == 0);
    }
    CHECK(kernels("") == warm);
}
