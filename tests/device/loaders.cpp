// Other OpenCL loaders than the one that Opal was linked with find the same devices, which compute the same.
#include "base/json.h"
#include "support/device.h"
#include "support/scratch.h"

#include <cstdlib>
#include <sstream>

using namespace opal::test;

namespace {

struct Answers {
    std::vector<std::string> devices;
    std::string numbers; // the figures of selftest, the same in every run
};

Answers answers(const std::string &environment) {
    const Outcome listed = run_shell(environment + OPAL_BINARY " devices --json -");
    INFO(environment << listed.out << listed.err);
    REQUIRE(listed.exit_code == 0);
    Answers all;
    for (const nlohmann::json &device : nlohmann::json::parse(listed.out)["devices"])
        all.devices.push_back(device["platform"].get<std::string>() + ", " + device["name"].get<std::string>() +
                              device["problem"].get<std::string>());
    const ScratchFolder folder;
    const Outcome checked = run_shell(environment + OPAL_BINARY " selftest --group basics --device " +
                                      std::to_string(device().info.index) + " --json " + (folder / "out").string());
    INFO(checked.out << checked.err);
    CHECK(checked.exit_code == 0);
    all.numbers = nlohmann::json::parse(read_text(folder / "out"))["checks"].dump();
    return all;
}

} // namespace

TEST_CASE("Other OpenCL loaders find the same devices", "[loaders][skips]") {
    const char *const folders = std::getenv("OPAL_TEST_LOADERS");
    if (!folders) {
        WARN("skipped: OPAL_TEST_LOADERS names no folder that holds another libOpenCL.so.1 (PyPI's nvidia-cuda-opencl "
             "has Khronos's)");
        return;
    }
    const Answers own = answers("");
    std::istringstream list(folders);
    for (std::string folder; std::getline(list, folder, ':');) {
        REQUIRE(std::filesystem::exists(std::filesystem::path(folder) / "libOpenCL.so.1"));
        const Answers others = answers("LD_LIBRARY_PATH=" + folder + "${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} ");
        CHECK(others.devices == own.devices);
        CHECK(others.numbers == own.numbers);
    }
}
