// DeviceInfo as JSON: what a probe says to the process that started it, and what `opal devices --json` prints.
#pragma once

#include "base/json.h"
#include "device/context.h"

namespace opal {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviceInfo, index, platform, name, vendor, type, version, driver, memory,
                                   max_allocation, compute_units, fp64, vector_width, native_lanes, library,
                                   platform_place, device_place, problem)

} // namespace opal
