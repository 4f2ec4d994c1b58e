// The host's code for GPUs, on a CPU device that says it is one (support/posing_preload.cpp): work-groups of 64, a
// pixel a work-item, buffers that are copied.
#include "base/json.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <map>
#include <set>
#include <sstream>

using namespace opal::test;

namespace {

const std::string scenes = OPAL_SOURCE_DIR "/scenes/";

Outcome run(const std::string &environment, const std::string &arguments) {
    const Outcome outcome = run_shell(environment + OPAL_BINARY + " " + arguments);
    INFO(arguments << "\n" << outcome.out << outcome.err);
    CHECK(outcome.exit_code == 0);
    return outcome;
}

const std::string preload = "LD_PRELOAD=" OPAL_POSING " ";

Outcome as_gpu(const std::string &arguments) { return run(preload + "OPAL_POSE=gpu ", arguments + " --device gpu"); }
Outcome as_cpu(const std::string &arguments) { return run("", arguments + " --device cpu"); }

} // namespace

TEST_CASE("A GPU passes the quick selftest", "[posing][stat]") {
    CHECK_THAT(as_gpu("selftest --quick").out, Catch::Contains("passed: ") && !Catch::Contains("!"));
}

TEST_CASE("selftest asks functions in the work-groups that render", "[posing]") {
    for (const auto &[device, size] : {std::pair("gpu", "64"), {"cpu", "1"}}) {
        const ScratchFolder folder;
        const std::string log = (folder / "log").string(),
                          environment = preload + "OPAL_POSE=" + device + " OPAL_LAUNCHES=" + log + " ";
        run(environment, "selftest --group basics --device " + std::string(device));
        run(environment, "render " + scenes + "cbox_mis.xml --width 16 --spp 1 --no-png -o " +
                             (folder / "out.exr").string() + " --device " + device);
        std::map<std::string, std::set<std::string>> sizes; // of each kernel
        std::istringstream launches(read_text(log));
        for (std::string kernel, local; launches >> kernel >> local;)
            sizes[kernel].insert(local);
        INFO(device);
        for (const char *kernel : {"render", "math_values", "numbers"})
            CHECK(sizes[kernel] == std::set<std::string>{size});
    }
}

TEST_CASE("A GPU's pictures are those of a CPU at one lane", "[posing]") {
    const ScratchFolder folder;
    const std::string gpu = (folder / "gpu.exr").string(), cpu = (folder / "cpu.exr").string(),
                      file = (folder / "compare.json").string();
    for (const char *scene : {"cbox_mis", "mixed_room", "veach_mis"}) {
        const std::string render = "render " + scenes + scene + ".xml --width 40 --spp 16 --no-png --lanes 1 -o ";
        as_gpu(render + gpu);
        as_cpu(render + cpu);
        run("", "compare " + gpu + " " + cpu + " --json " + file);
        const nlohmann::json errors = nlohmann::json::parse(read_text(file));
        INFO(scene);
        CHECK(errors["max_difference"] == 0.0);
        CHECK(errors["rel_mse"] == 0.0);
    }
}

TEST_CASE("bench render does not compile a GPU's kernel for vectors", "[posing]") {
    const ScratchFolder folder;
    const std::string file = (folder / "json").string();
    as_gpu("bench render " + scenes + "cbox_mis.xml --seconds 0.01 --rounds 1 --json " + file);
    const nlohmann::json widths = nlohmann::json::parse(read_text(file))["widths"];
    CHECK(widths.size() == 1);
    CHECK(widths.contains("1"));
}
