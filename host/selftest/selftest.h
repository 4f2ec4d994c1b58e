// Does this device, with its driver, compute right? Groups of checks, each meant to be run in a process of its own.
#pragma once

#include "device/program.h"
#include "selftest/finding.h"

namespace opal {

struct SelftestOptions {
    BuildOptions build;
    const Sources *sources = &Sources::embedded();
    bool full = false; // more cases, angles and samples
    unsigned seed = 0;
};

struct CheckGroup {
    const char *name, *help;
    Findings (*run)(const Device &device, const SelftestOptions &options);
};
const std::vector<CheckGroup> &check_groups();

// The groups, a file each (check_NAME.cpp): one finding a check, over all its cases.
Findings run_basics(const Device &device, const SelftestOptions &options);
Findings run_warps(const Device &device, const SelftestOptions &options);
Findings run_bsdfs(const Device &device, const SelftestOptions &options);
Findings run_lights(const Device &device, const SelftestOptions &options);
Findings run_rays(const Device &device, const SelftestOptions &options);
Findings run_images(const Device &device, const SelftestOptions &options);

// The math functions alone, as a kernel of this width and math computes them.
Findings check_functions(const Device &device, const BuildOptions &build, const Sources &sources);

} // namespace opal
