// Does this device, with its driver, compute right? Groups of checks, each meant to be run in a process of its own.
#pragma once

#include "device/context.h"
#include "device/sources.h"

#include <string>
#include <vector>

namespace opal {

struct SelftestOptions {
    BuildOptions build;
    const Sources *sources = &Sources::embedded();
    bool full = false;
    unsigned seed = 0;
};

// A figure against its limit. What is wrong may be a NaN: then it has not passed.
struct Finding {
    std::string check; // "warps: smallest p"
    double figure = 0, limit = 0;
    bool passed = false;
};

inline Finding at_most(std::string check, double figure, double limit) {
    return {std::move(check), figure, limit, figure <= limit};
}
inline Finding at_least(std::string check, double figure, double limit) {
    return {std::move(check), figure, limit, figure >= limit};
}

// The larger of two figures; NaN is larger than anything.
inline double worst_of(double a, double b) { return a != a || a > b ? a : b; }

using Findings = std::vector<Finding>;
struct CheckGroup {
    const char *name, *help;
    Findings (*run)(const Device &device, const SelftestOptions &options);
};
const std::vector<CheckGroup> &check_groups();

// The groups' checks, a file each (check_NAME.cpp).
Findings check_basics(const Device &device, const SelftestOptions &options);
Findings check_warps(const Device &device, const SelftestOptions &options);
Findings check_bsdfs(const Device &device, const SelftestOptions &options);
Findings check_lights(const Device &device, const SelftestOptions &options);
Findings check_rays(const Device &device, const SelftestOptions &options);
Findings check_images(const Device &device, const SelftestOptions &options);

// The math functions alone, as a kernel of this width and math computes them.
Findings check_functions(const Device &device, const BuildOptions &build, const Sources &sources);

// Samples of a histogram, and cells along each side of its grid.
inline size_t selftest_samples(const SelftestOptions &options) { return options.full ? 1'000'000 : 60'000; }
inline int selftest_cells(const SelftestOptions &options) { return options.full ? 40 : 16; }

// Level of each check that judges samples: one false alarm in ten thousand right devices, at about ten such checks.
inline constexpr double selftest_level = 1e-5;

} // namespace opal
