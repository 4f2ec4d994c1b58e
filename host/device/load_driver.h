// Loads one driver into this process and visits its devices. Only probe-platform and open_device use it.
#pragma once

#include "device/opencl.h"

#include <functional>

namespace opal {

// library: the driver's, as dlopen takes it; empty: whatever the loader finds. `use` gets each device in the loader's
// order. A platform or device that fails a question, or a library that gives no platform, is described by its
// `problem`.
void for_each_device(const std::string &library,
                     const std::function<void(const DeviceInfo &, const cl::Device &)> &use);

// The path of a loaded library. Empty if it is not loaded.
std::string library_path(const std::string &library);

} // namespace opal
