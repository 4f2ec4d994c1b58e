#include "selftest/selftest.h"

namespace opal {

const std::vector<CheckGroup> &check_groups() {
    static const std::vector<CheckGroup> groups = {
        {"basics", "layout of records, random numbers, math functions", check_basics},
        {"warps", "warps against their densities", check_warps},
        {"bsdfs", "BSDFs against their densities and values", check_bsdfs},
        {"lights", "points on lights against their densities", check_lights},
        {"rays", "closest and any hit against brute force, watertightness", check_rays},
        {"images", "the furnace, and strategies against each other", check_images},
    };
    return groups;
}

} // namespace opal
