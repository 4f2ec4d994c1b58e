// DeviceInfo as JSON: what a probe says to the process that started it, and what `opal devices --json` prints.
#pragma once

#include "device/context.h"
#include <nlohmann/json_fwd.hpp>

namespace opal {

void to_json(nlohmann::json &json, const DeviceInfo &info);
void from_json(const nlohmann::json &json, DeviceInfo &info);

} // namespace opal
