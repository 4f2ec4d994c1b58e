// DeviceInfo as JSON: what a probe says to the process that started it, and what `opal devices --json` prints.
#pragma once

#include "base/json.h"
#include "device/context.h"

namespace opal {

void to_json(nlohmann::json &json, const DeviceInfo &info);
void from_json(const nlohmann::json &json, DeviceInfo &info);

} // namespace opal
