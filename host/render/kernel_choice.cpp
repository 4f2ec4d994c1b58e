#include "render/kernel_choice.h"

#include "flatten/features.h"

#include <algorithm>

namespace opal {

bool suits_general_kernel(const DeviceInfo &device, double paths) {
    return device.type != "gpu" && paths < paths_that_pay;
}

bool suits_general_kernel(const DeviceInfo &device, double paths, const SceneDescription &scene) {
    return suits_general_kernel(device, paths) && shares_general_kernel(scene);
}

double paths_in(const DeviceInfo &device, double seconds) {
    constexpr double paths_a_second = 2e6; // of a core: measured on our heaviest scene
    return seconds * paths_a_second * std::max(1u, device.compute_units);
}

} // namespace opal
