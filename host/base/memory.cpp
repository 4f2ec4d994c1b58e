#include "base/memory.h"

#include "base/error.h"
#include "base/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include <sys/resource.h>

namespace opal {

namespace {

namespace fs = std::filesystem;

// The number behind a word in a file of lines "word number": of the first such line.
std::optional<double> number_in(const fs::path &file, const std::string &word) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        std::istringstream words(line);
        std::string first;
        double number;
        if (words >> first && first == word && words >> number)
            return number;
    }
    return std::nullopt;
}

// The number that is all of a file; nothing if it is a word, such as "max".
std::optional<double> only_number_in(const fs::path &file) {
    std::ifstream stream(file);
    double number;
    return stream >> number ? std::optional(number) : std::nullopt;
}

double left_by_rlimits() {
    double left = INFINITY;
    const auto limit = [&](auto resource, const std::string &used) {
        rlimit limits{};
        if (getrlimit(resource, &limits) != 0 || limits.rlim_cur == RLIM_INFINITY)
            return;
        left = std::min(left, double(limits.rlim_cur) - 1024 * number_in("/proc/self/status", used).value_or(0));
    };
    limit(RLIMIT_AS, "VmSize:");
    limit(RLIMIT_DATA, "VmData:");
    return left;
}

// What one group leaves. Each version has names of its own.
double left_by_group(const fs::path &group, const char *limit, const char *usage, const char *cached) {
    const std::optional<double> most = only_number_in(group / limit), used = only_number_in(group / usage);
    if (!most || !used)
        return INFINITY;
    return *most - *used + number_in(group / "memory.stat", cached).value_or(0);
}

// cgroups(7): a line of /proc/self/cgroup is "number:controllers:path"; version 2 has no controllers.
double left_by_groups() {
    double left = INFINITY;
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        const size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos)
            continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const bool unified = controllers.empty();
        if (!unified && ("," + controllers + ",").find(",memory,") == std::string::npos)
            continue;
        const fs::path root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
        // A container may show its group's path as the machine has it, and only its own files.
        for (fs::path group = line.substr(second + 1);; group = group.parent_path()) {
            const fs::path folder = root / group.relative_path();
            left = std::min(left, unified ? left_by_group(folder, "memory.max", "memory.current", "inactive_file")
                                          : left_by_group(folder, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                                          "total_inactive_file"));
            if (!group.has_relative_path())
                break;
        }
    }
    return left;
}

double left_by_machine() {
    const std::optional<double> available = number_in("/proc/meminfo", "MemAvailable:");
    return available ? 1024 * (*available + number_in("/proc/meminfo", "SwapFree:").value_or(0)) : INFINITY;
}

} // namespace

void check_memory(double resident, double reserved, const std::string &what) {
    constexpr double small = 64 << 20; // not worth the question, which takes 0.2 ms
    if (std::max(resident, reserved) < small)
        return;
    struct Limit {
        double wanted, left;
        const char *name;
    };
    for (const Limit &limit : {Limit{reserved, left_by_rlimits(), "ulimit -v or -d"},
                               Limit{resident, left_by_groups(), "the limit of the control group"},
                               Limit{resident, left_by_machine(), "this machine's memory and swap space"}})
        if (limit.wanted > limit.left)
            throw Error(fmt::format("{}: about {} of memory wanted, and {} are left ({})", what,
                                    bytes_text(static_cast<unsigned long long>(limit.wanted)),
                                    bytes_text(static_cast<unsigned long long>(std::max(limit.left, 0.0))),
                                    limit.name));
}

} // namespace opal
