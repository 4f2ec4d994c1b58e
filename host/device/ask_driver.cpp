#include "device/ask_driver.h"

#include "base/json.h"
#include "base/log.h"
#include "base/process.h"
#include "base/read_file.h"
#include "device/info_json.h"
#include "device/load_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

namespace opal {

namespace {

namespace fs = std::filesystem;

const std::string line_mark = "opal-device "; // drivers print to stdout too
fs::path probe_binary = "/proc/self/exe";

struct Probe {
    Driver driver;
    std::optional<ChildProcess> process; // none if there is no library to load
};

Probe start_probe(const Driver &driver) {
    std::vector<std::string> words = {"probe-platform"};
    if (!driver.library.empty())
        words.push_back(driver.library);
    else if (!driver.name.empty())
        return {driver, std::nullopt};
    return {driver, ChildProcess(probe_binary, words)};
}

DeviceInfo problem_line(const Driver &driver, const std::string &problem) {
    DeviceInfo line;
    line.platform = driver.name.empty() ? "OpenCL" : driver.name;
    line.library = driver.library;
    line.problem = problem;
    return line;
}

// The problem of a process that ended this way; empty if there is none.
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
    if (!probe.process)
        return {problem_line(probe.driver, "names no library, or cannot be read")};
    const Ending ending = probe.process->finish(deadline);
    std::vector<DeviceInfo> devices;
    std::istringstream lines(probe.process->said());
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(line_mark)) {
            devices.push_back(parse_json(line.substr(line_mark.size())).get<DeviceInfo>());
            if (devices.back().platform.empty())
                devices.back().platform = probe.driver.name;
        }
    if (const std::string problem = problem_of(ending, time_limit); !problem.empty())
        devices.push_back(problem_line(probe.driver, problem));
    return devices;
}

// The library in an .icd file: its first line that is neither blank nor a comment. Empty if there is none, or if the
// file cannot be read.
std::string library_of(const fs::path &icd) {
    std::istringstream lines;
    try {
        lines.str(read_file(icd));
    } catch (const Error &) {
        return {};
    }
    for (std::string line; std::getline(lines, line);) {
        const size_t first = line.find_first_not_of(" \t\r");
        if (first != std::string::npos && line[first] != '#')
            return line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
    }
    return {};
}

Driver driver_of(const fs::path &icd) { return {icd.string(), library_of(icd)}; }

std::vector<Driver> drivers_in(const fs::path &folder) {
    std::error_code ignored;
    std::vector<fs::path> files;
    for (const auto &entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".icd")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<Driver> drivers;
    std::transform(files.begin(), files.end(), std::back_inserter(drivers), driver_of);
    return drivers;
}

// A variable of the environment; empty if it is not set.
std::string variable(const char *name) {
    const char *const text = std::getenv(name);
    return text ? text : "";
}

} // namespace

void set_probe_binary(const fs::path &binary) { probe_binary = binary; }
const fs::path &own_binary() { return probe_binary; }

std::vector<Driver> find_drivers() {
    std::vector<Driver> drivers;
    std::istringstream libraries(variable("OCL_ICD_FILENAMES"));
    for (std::string library; std::getline(libraries, library, ':');)
        if (!library.empty())
            drivers.push_back({library, library});

    const std::string given = variable("OCL_ICD_VENDORS"), usual = variable("OPENCL_VENDOR_PATH");
    const fs::path folder = usual.empty() ? "/etc/OpenCL/vendors" : usual;
    std::error_code ignored;
    if (given.empty() || fs::is_directory(given, ignored)) {
        const std::vector<Driver> more = drivers_in(given.empty() ? folder : fs::path(given));
        drivers.insert(drivers.end(), more.begin(), more.end());
    } else if (fs::path(given).extension() != ".icd") {
        drivers.push_back({given, given});
    } else { // a name without a slash is looked for in the usual folder first
        const bool usual_one = given.find('/') == std::string::npos && fs::exists(folder / given, ignored);
        drivers.push_back(driver_of(usual_one ? folder / given : fs::path(given)));
    }
    return drivers.empty() ? std::vector<Driver>{Driver()} : drivers;
}

std::string loader_path() { return library_path("libOpenCL.so.1"); }

std::vector<DeviceInfo> probe_drivers(const std::vector<Driver> &drivers, double time_limit) {
    using Clock = ChildProcess::Clock;
    const auto deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_limit));
    std::vector<Probe> probes;
    for (const Driver &driver : drivers)
        probes.push_back(start_probe(driver));
    std::vector<DeviceInfo> devices;
    std::set<fs::path> known; // one library may have several names
    for (Probe &probe : probes) {
        const std::vector<DeviceInfo> found = finish_probe(probe, deadline, time_limit);
        std::error_code ignored;
        if (found.empty() || (probe.process && !known.insert(fs::weakly_canonical(found[0].library, ignored)).second))
            continue;
        devices.insert(devices.end(), found.begin(), found.end());
    }
    return devices;
}

void print_probe(const std::string &library) {
    for_each_device(library,
                    [](const DeviceInfo &info, const cl::Device &) { print("{}{}\n", line_mark, dump(info)); });
}

} // namespace opal
