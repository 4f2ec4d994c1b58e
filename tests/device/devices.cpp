// Finding devices: one that crashes, hangs or says nothing costs its own line, and the choice among the others is explained.
#include "device/probe.h"
#include "support/device.h"
#include "support/scratch.h"

#include <cstdlib>

using namespace opal;
using namespace opal::test;

namespace {

// A driver whose first entry point, which the loader calls before anything else, does what `body` says.
std::filesystem::path make_driver(const ScratchFolder &folder, const std::string &name, const std::string &body) {
    const std::filesystem::path source = folder.write(name + ".c", "#include <stdlib.h>\n#include <unistd.h>\n"
                                                                   "void *clGetExtensionFunctionAddress(const char *name) {\n    (void)name;\n    " +
                                                                       body + "\n    return 0;\n}\n");
    const std::string library = folder / ("lib" + name + ".so");
    const Outcome built = run_shell("cc -shared -fPIC " + source.string() + " -o " + library);
    INFO(built.err);
    REQUIRE(built.exit_code == 0);
    return folder.write("vendors/" + name + ".icd", library + "\n");
}

DeviceInfo listed(int index, const std::string &type, const std::string &name, const std::string &problem = "") {
    DeviceInfo info;
    info.index = index;
    info.type = type;
    info.name = name;
    info.platform = "Platform of " + name;
    info.problem = problem;
    return info;
}

// A driver that has a usable device: others may be installed that have none.
std::filesystem::path good_driver() {
    for (const std::filesystem::path &driver : find_drivers())
        if (const auto devices = probe_drivers({driver}, 60); !devices.empty() && devices[0].problem.empty())
            return driver;
    FAIL("no driver has a device");
    return {};
}

const std::vector<DeviceInfo> several = {listed(0, "cpu", "llvmpipe (LLVM 15)"), listed(1, "cpu", "Ryzen"),
                                         listed(2, "gpu", "Old GPU", "crashed while it was asked"), listed(3, "gpu", "Radeon"),
                                         listed(4, "gpu", "GeForce")};

} // namespace

TEST_CASE("A driver that crashes or hangs costs its line and no other", "[devices]") {
    set_probe_binary(OPAL_BINARY);
    const ScratchFolder folder;
    const std::vector<std::filesystem::path> drivers = {make_driver(folder, "crash", "abort();"), make_driver(folder, "hang", "sleep(60);"),
                                                        good_driver()};
    const std::vector<DeviceInfo> found = probe_drivers(drivers, 3);
    REQUIRE(found.size() >= 3);
    CHECK(found[0].problem == "crashed while it was asked (Aborted)");
    CHECK(found[0].platform == drivers[0].string());
    CHECK(found[1].problem == "did not answer within 3 s");
    CHECK(found[2].problem == "");
    CHECK(found[2].memory > 0);
}

TEST_CASE("opal devices survives a crashing driver beside a good one", "[devices]") {
    const ScratchFolder folder;
    make_driver(folder, "a_crash", "abort();");
    set_probe_binary(OPAL_BINARY);
    const std::filesystem::path good = good_driver();
    std::filesystem::copy(good, folder / ("vendors/" + good.filename().string()));
    const std::string environment = "OCL_ICD_VENDORS=" + (folder / "vendors").string() + " ";
    const Outcome outcome = run_shell(environment + OPAL_BINARY + " devices");
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Catch::Contains("a_crash.icd: crashed while it was asked") && Catch::Contains("render takes 1: "));
    const Outcome refused = run_shell(environment + OPAL_BINARY + " devices --device 0");
    CHECK(refused.exit_code == 1);
    CHECK_THAT(refused.err, Catch::StartsWith("error: device 0 ") && Catch::Contains("crashed while it was asked"));
}

TEST_CASE("Without any driver the message says what to install", "[devices]") {
    const ScratchFolder folder;
    const Outcome outcome = run_shell("OCL_ICD_VENDORS=" + folder.path().string() + " " + OPAL_BINARY + " devices");
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Catch::StartsWith("error: no usable OpenCL device") && Catch::Contains("pocl-opencl-icd"));
}

TEST_CASE("The default is the first usable GPU, else a CPU, else a software rasteriser", "[devices]") {
    const auto pick = [](std::vector<DeviceInfo> devices) { return pick_device("", devices); };
    CHECK(pick(several).info.index == 3);
    CHECK(pick({several[0], several[1], several[2]}).info.index == 1);
    CHECK(pick({several[0], several[1]}).reason == "the first CPU device, as there is no GPU");
    CHECK(pick({several[0]}).reason == "only a software rasteriser was found");
    CHECK_THROWS_WITH(pick({several[2]}), Catch::Contains("no usable OpenCL device; found: 2 (Platform of Old GPU: crashed"));
}

TEST_CASE("A device is chosen by index, type or part of its name", "[devices]") {
    CHECK(pick_device("4", several).info.name == "GeForce");
    CHECK(pick_device("gpu", several).info.name == "Radeon");
    CHECK(pick_device("CPU", several).info.index == 0);
    CHECK(pick_device("ryz", several).info.name == "Ryzen");
    CHECK_THROWS_WITH(pick_device("2", several), Catch::StartsWith("device 2 (Platform of Old GPU) cannot be used: it crashed"));
    CHECK_THROWS_WITH(pick_device("9", several), Catch::StartsWith("no OpenCL device \"9\"; available: 0 (cpu, llvmpipe"));
    CHECK_THROWS_WITH(pick_device("Voodoo", several), Catch::Contains("4 (gpu, GeForce)"));
}

TEST_CASE("The device that is opened is the one that was listed", "[devices]") {
    CHECK(device().device.getInfo<CL_DEVICE_NAME>().find(device().info.name) != std::string::npos);
    CHECK(device().queue.getInfo<CL_QUEUE_PROPERTIES>() == CL_QUEUE_PROFILING_ENABLE);
    const std::string wanted = std::to_string(device().info.index);
    CHECK_THAT(run_shell(std::string(OPAL_BINARY) + " devices --json --device " + wanted).out, Catch::Contains(device().info.driver));
}
