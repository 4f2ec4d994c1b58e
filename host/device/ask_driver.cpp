#include "device/ask_driver.h"

#include "base/environment.h"
#include "base/hash.h"
#include "base/json.h"
#include "base/log.h"
#include "base/process.h"
#include "base/read_file.h"
#include "device/info_json.h"
#include "device/kernel_cache.h"
#include "device/load_driver.h"
#include "device/work_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <set>
#include <sstream>

#include <fcntl.h>
#include <unistd.h>

namespace opal {

namespace {

namespace fs = std::filesystem;

fs::path probe_binary = "/proc/self/exe";

struct Probe {
    Driver driver;
    std::optional<ChildProcess> process{}; // none if there is no library to load
    std::string problem{};                 // why there is no process
};

Probe start_probe(const Driver &driver) {
    std::vector<std::string> words = {"probe-platform", "--to-parent"};
    if (!driver.library.empty())
        words.push_back(driver.library);
    else if (!driver.name.empty())
        return {driver, std::nullopt, driver.problem};
    return {driver, ChildProcess(probe_binary, words)};
}

DeviceInfo problem_line(const Driver &driver, const std::string &problem) {
    DeviceInfo line;
    line.platform = driver.name.empty() ? "OpenCL" : driver.name;
    line.library = driver.library;
    line.problem = problem;
    return line;
}

const std::string hung_before = "did not answer within the last hour, and is not asked again; `opal devices` asks it";

// A file in the cache's folder that says when a driver did not answer.
class Silence {
public:
    explicit Silence(const Driver &driver) {
        const fs::path folder = cache_folder().path;
        std::error_code error; // the time, as another library may answer
        const fs::path library = driver.library;
        const auto changed = library.is_absolute() ? fs::last_write_time(library, error) : fs::file_time_type();
        if (!folder.empty() && !driver.library.empty())
            file_ = folder / (xxh128(fmt::format("{}\n{}\n{}", driver.name, driver.library,
                                                 error ? 0 : changed.time_since_epoch().count())) +
                              silent_extension);
    }
    bool is_fresh() const {
        std::error_code error;
        const auto since = fs::file_time_type::clock::now() - fs::last_write_time(file_, error);
        return !error && since >= since.zero() && since < std::chrono::hours(1); // a clock may have been put back
    }
    void keep() const {
        forget();
        if (!file_.empty())
            close(open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR));
    }
    void forget() const { unlink(file_.c_str()); }

private:
    fs::path file_; // empty: nothing can be noted
};

// The problem of a process that ended this way; empty if there is none.
std::string problem_of(const Ending &ending, double time_limit) {
    if (ending.too_long)
        return "gave too long an answer";
    if (!ending.in_time)
        return fmt::format("did not answer within {:g} s", time_limit);
    if (ending.signal)
        return fmt::format("crashed while it was asked ({})", ending.signal_name());
    if (ending.exit_code)
        return fmt::format("failed while it was asked (exit code {})", ending.exit_code);
    return {};
}

std::vector<DeviceInfo> finish_probe(Probe &probe, ChildProcess::Clock::time_point deadline, double time_limit,
                                     bool ask_all) {
    if (!probe.process)
        return {problem_line(probe.driver, probe.problem)};
    const Ending ending = probe.process->finish(deadline);
    std::string problem = problem_of(ending, time_limit);
    std::vector<DeviceInfo> devices;
    std::istringstream lines(probe.process->said());
    try {
        for (std::string line; std::getline(lines, line);) {
            devices.push_back(parse_json(line).get<DeviceInfo>());
            if (devices.back().platform.empty())
                devices.back().platform = probe.driver.name;
        }
    } catch (const nlohmann::json::exception &) {
        if (problem.empty()) // else the process ended within a line
            problem = "gave an answer that cannot be read";
    }
    if (!problem.empty())
        devices.push_back(problem_line(probe.driver, problem));
    if (ending.in_time)
        Silence(probe.driver).forget();
    else if (!ask_all) { // others may have a short limit
        Silence(probe.driver).keep();
        warn(fmt::format("{}: {}", devices.back().platform, problem));
    }
    return devices;
}

// The library in an .icd file is its first line that is neither blank nor a comment.
Driver driver_of(const fs::path &icd) {
    std::istringstream lines;
    try {
        std::error_code ignored;
        if (fs::exists(icd, ignored) && !fs::is_regular_file(icd, ignored))
            return {icd.string(), {}, "is no regular file"};
        lines.str(read_file(icd));
    } catch (const Error &error) {
        return {icd.string(), {}, std::string(error.what()).substr(icd.string().size() + 2)}; // "FILE: cannot read"
    }
    for (std::string line; std::getline(lines, line);) {
        const size_t first = line.find_first_not_of(" \t\r");
        if (first != std::string::npos && line[first] != '#')
            return {icd.string(), line.substr(first, line.find_last_not_of(" \t\r") - first + 1), {}};
    }
    return {icd.string(), {}, "names no library"};
}

std::vector<Driver> drivers_in(const fs::path &folder) {
    std::error_code error;
    std::vector<fs::path> files;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (at->path().extension() == ".icd")
            files.push_back(at->path());
    std::sort(files.begin(), files.end());
    std::vector<Driver> drivers;
    std::transform(files.begin(), files.end(), std::back_inserter(drivers), driver_of);
    if (error && error != std::errc::no_such_file_or_directory)
        drivers.push_back({folder.string(), {}, "cannot be read: " + error.message()});
    return drivers;
}

// A path that is looked up from the working directory, made absolute. Names without a slash are the dynamic linker's.
std::string absolute_library(const std::string &library) {
    return library.find('/') == std::string::npos ? library : fs::absolute(library).lexically_normal().string();
}

} // namespace

void set_probe_binary(const fs::path &binary) { probe_binary = binary; }
const fs::path &own_binary() { return probe_binary; }

std::vector<Driver> find_drivers() {
    std::vector<Driver> drivers;
    std::istringstream libraries(variable("OCL_ICD_FILENAMES"));
    for (std::string library; std::getline(libraries, library, ':');)
        if (!library.empty())
            drivers.push_back({library, absolute_library(library), {}});

    const std::string given = variable("OCL_ICD_VENDORS"), usual = variable("OPENCL_VENDOR_PATH");
    const fs::path folder = usual.empty() ? "/etc/OpenCL/vendors" : usual;
    std::error_code ignored;
    if (given.empty() || fs::is_directory(given, ignored)) {
        const std::vector<Driver> more = drivers_in(given.empty() ? folder : fs::path(given));
        drivers.insert(drivers.end(), more.begin(), more.end());
    } else if (fs::path(given).extension() != ".icd") {
        drivers.push_back({given, absolute_library(given), {}});
    } else { // a name without a slash is looked for in the usual folder first
        const bool usual_one = given.find('/') == std::string::npos && fs::exists(folder / given, ignored);
        drivers.push_back(driver_of(usual_one ? folder / given : fs::path(given)));
    }
    return drivers.empty() ? std::vector<Driver>{Driver()} : drivers;
}

std::string loader_path() { return library_path("libOpenCL.so.1"); }

std::vector<DeviceInfo> probe_drivers(const std::vector<Driver> &drivers, double time_limit, bool ask_all) {
    using Clock = ChildProcess::Clock;
    const DriverScope scope; // drivers start in its working directory
    const ScopedVariable cache(pocl_cache_variable, WorkFolder::own().driver_files());
    const auto deadline =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(time_limit));
    std::vector<Probe> probes;
    bool passed_over = false;
    for (const Driver &driver : drivers)
        if (ask_all || !Silence(driver).is_fresh())
            probes.push_back(start_probe(driver));
        else {
            probes.push_back({driver, std::nullopt, hung_before});
            warn(fmt::format("{}: {}", driver.name, hung_before));
            passed_over = true;
        }
    std::vector<DeviceInfo> devices;
    std::set<fs::path> known; // one library may have several names
    for (Probe &probe : probes) {
        const std::vector<DeviceInfo> found = finish_probe(probe, deadline, time_limit, ask_all);
        std::error_code ignored;
        if (found.empty())
            continue;
        const fs::path library = found[0].library;
        const fs::path place = library.is_absolute() ? fs::weakly_canonical(library, ignored) : library;
        if (probe.process && !known.insert(place).second)
            continue;
        devices.insert(devices.end(), found.begin(), found.end());
    }
    const auto usable = [](const DeviceInfo &device) { return device.problem.empty(); };
    if (passed_over && std::ranges::none_of(devices, usable)) // it may have been slow for once
        return probe_drivers(drivers, time_limit, true);
    return devices;
}

void answer_probe(const std::string &library, bool to_parent) {
    if (to_parent)
        begin_answer();
    for_each_device(library, [](const DeviceInfo &info, const cl::Device &) { answer(dump(info)); });
    if (to_parent)
        end_answer();
}

} // namespace opal
