// Loading one driver into this process and walking through its devices. Only the probe and open_device do so.
#pragma once

#include "device/context.h"

#include <functional>

namespace opal {

// icd: the driver's .icd file, or empty for whatever the loader finds. `use` gets each device in the loader's order.
// A platform or device that fails a question is described by its `problem`.
void for_each_device(const std::string &icd, const std::function<void(const DeviceInfo &, const cl::Device &)> &use);

} // namespace opal
