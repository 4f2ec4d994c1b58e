#include "device/probe.h"

#include "base/process.h"
#include "device/info_json.h"
#include "device/load_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <sstream>

namespace opal {

namespace {

namespace fs = std::filesystem;

const std::string line_mark = "opal-device "; // drivers print to stdout too
fs::path probe_binary = "/proc/self/exe";

struct Probe {
    fs::path driver;
    ChildProcess process;
};

Probe start_probe(const fs::path &driver) {
    std::vector<std::string> words = {"probe-platform"};
    if (!driver.empty())
        words.push_back(driver.string());
    return {driver, ChildProcess(probe_binary, words)};
}

// What is wrong with a process that ended this way; empty: nothing.
std::string problem_of(const Ending &ending, double time_limit) {
    if (!ending.in_time)
        return fmt::format("did not answer within {:g} s", time_limit);
    if (ending.signal)
        return fmt::format("crashed while it was asked ({})", ending.signal_name());
    if (ending.exit_code)
        return fmt::format("failed while it was asked (exit code {})", ending.exit_code);
    return {};
}

std::vector<DeviceInfo> finish_probe(Probe &probe, ChildProcess::Clock::time_point deadline, double time_limit) {
    const Ending ending = probe.process.finish(deadline);
    std::vector<DeviceInfo> devices;
    std::istringstream lines(probe.process.said());
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(line_mark))
            devices.push_back(nlohmann::json::parse(line.substr(line_mark.size())).get<DeviceInfo>());
    if (const std::string problem = problem_of(ending, time_limit); !problem.empty()) {
        DeviceInfo bad;
        bad.platform = probe.driver.empty() ? "OpenCL" : probe.driver.string();
        bad.icd = probe.driver.string();
        bad.problem = problem;
        devices.push_back(bad);
    }
    return devices;
}

} // namespace

void set_probe_binary(const fs::path &binary) { probe_binary = binary; }
const fs::path &own_binary() { return probe_binary; }

std::vector<fs::path> find_drivers() {
    const char *given = std::getenv("OCL_ICD_VENDORS");
    const fs::path folder = given ? given : "/etc/OpenCL/vendors";
    std::error_code ignored;
    std::vector<fs::path> drivers;
    for (const auto &entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".icd")
            drivers.push_back(entry.path());
    std::sort(drivers.begin(), drivers.end());
    return drivers.empty() ? std::vector<fs::path>{fs::path()} : drivers;
}

std::vector<DeviceInfo> probe_drivers(const std::vector<fs::path> &drivers, double time_limit) {
    using Clock = ChildProcess::Clock;
    const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_limit));
    std::vector<Probe> probes;
    for (const auto &driver : drivers)
        probes.push_back(start_probe(driver));
    std::vector<DeviceInfo> devices;
    for (Probe &probe : probes)
        for (DeviceInfo &device : finish_probe(probe, deadline, time_limit))
            devices.push_back(std::move(device));
    return devices;
}

void print_probe(const std::string &icd) {
    for_each_device(icd, [](const DeviceInfo &info, const cl::Device &) {
        std::cout << line_mark << dump(info, -1) << std::endl;
    });
}

} // namespace opal
