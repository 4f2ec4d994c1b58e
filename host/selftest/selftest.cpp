#include "selftest/checks.h"

namespace opal {

const std::vector<CheckGroup> &check_groups() {
    static const std::vector<CheckGroup> groups = {
        {"basics", "layout of records, random numbers, math functions", run_basics},
        {"warps", "warps against their densities", run_warps},
        {"bsdfs", "BSDFs against their densities and values", run_bsdfs},
        {"lights", "directions to lights against their densities", run_lights},
        {"rays", "closest and any hit against brute force, watertightness", run_rays},
        {"images", "the furnace, and strategies against each other", run_images},
    };
    return groups;
}

Effort effort_of(const SelftestOptions &options) {
    Effort effort;
    effort.seed = options.seed;
    if (options.build.math == MathMode::fast)
        effort.density_error = 2.5 * 0x1p-24; // 1 over the number of lights is off by so many ulp at most
    if (options.full) {
        effort.samples = 1'000'000;
        effort.nu = effort.nv = 40;
        effort.angles = {0, 15, 30, 45, 60, 75, 85, 89.9};
        effort.quadrature_error = 2e-3;
    }
    return effort;
}

} // namespace opal
