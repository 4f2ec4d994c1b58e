#include "device/probe.h"

#include "device/info_json.h"
#include "device/load_driver.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <iostream>
#include <poll.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace opal {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

const std::string line_mark = "opal-device "; // drivers print to stdout too
fs::path probe_binary = "/proc/self/exe";

struct Probe {
    fs::path driver;
    pid_t process = -1;
    int pipe = -1;
    std::string said;
};

Probe start_probe(const fs::path &driver) {
    Probe probe;
    probe.driver = driver;
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw Error(fmt::format("cannot start a process to ask OpenCL drivers: {}", std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    std::string words[] = {"opal", "probe-platform", driver.string()};
    char *arguments[] = {words[0].data(), words[1].data(), driver.empty() ? nullptr : words[2].data(), nullptr};
    const int failed = posix_spawn(&probe.process, probe_binary.c_str(), &actions, nullptr, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    probe.pipe = ends[0];
    if (failed) {
        close(ends[0]);
        throw Error(fmt::format("cannot start {} to ask OpenCL drivers: {}", probe_binary.string(), std::strerror(failed)));
    }
    return probe;
}

// Reads until the process closes its end. False: the time was up before.
bool read_all(Probe &probe, Clock::time_point deadline) {
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        pollfd wait{probe.pipe, POLLIN, 0};
        const int ready = poll(&wait, 1, static_cast<int>(std::max<long long>(left, 0)));
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready <= 0)
            return false;
        char bytes[4096];
        const ssize_t count = read(probe.pipe, bytes, sizeof bytes);
        if (count <= 0)
            return true;
        probe.said.append(bytes, static_cast<size_t>(count));
    }
}

// What is wrong with a process that ended this way; empty: nothing.
std::string problem_of(int status, bool in_time, double time_limit) {
    if (!in_time)
        return fmt::format("did not answer within {:g} s", time_limit);
    if (WIFSIGNALED(status))
        return fmt::format("crashed while it was asked ({})", strsignal(WTERMSIG(status)));
    if (WEXITSTATUS(status) != 0)
        return fmt::format("failed while it was asked (exit code {})", WEXITSTATUS(status));
    return {};
}

std::vector<DeviceInfo> finish_probe(Probe &probe, Clock::time_point deadline, double time_limit) {
    const bool in_time = read_all(probe, deadline);
    if (!in_time)
        kill(probe.process, SIGKILL);
    close(probe.pipe);
    int status = 0;
    while (waitpid(probe.process, &status, 0) < 0 && errno == EINTR) {
    }
    std::vector<DeviceInfo> devices;
    std::istringstream lines(probe.said);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with(line_mark))
            devices.push_back(nlohmann::json::parse(line.substr(line_mark.size())).get<DeviceInfo>());
    if (const std::string problem = problem_of(status, in_time, time_limit); !problem.empty()) {
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
