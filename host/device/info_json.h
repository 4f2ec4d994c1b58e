// DeviceInfo as JSON: what a probe says to the process that started it, and what `opal devices --json` prints.
#pragma once

#include "device/context.h"

#include <nlohmann/json.hpp>

namespace opal {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeviceInfo, index, platform, name, vendor, type, version, driver, memory, max_allocation,
                                   compute_units, fp64, vector_width, native_lanes, library, platform_place, device_place, problem)

// Text of a JSON value, whatever bytes a driver put into its names. indent -1: one line.
inline std::string dump(const nlohmann::json &json, int indent) {
    return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace opal
