// DeviceInfo as JSON, for `opal devices --json` and between the processes of ask_driver.h.
#pragma once

#include "device/context.h"
#include <nlohmann/json_fwd.hpp>

namespace opal {

void to_json(nlohmann::json &json, const DeviceInfo &info);
void from_json(const nlohmann::json &json, DeviceInfo &info);

} // namespace opal
