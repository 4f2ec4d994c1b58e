#include "render/kernel_choice.h"

namespace opal {

bool suits_general_kernel(const DeviceInfo &device, double paths) {
    return device.type != "gpu" && paths < paths_that_pay;
}

double paths_in(double seconds) {
    constexpr double paths_a_second = 4e6; // of two cores and our heaviest scene
    return seconds * paths_a_second;
}

} // namespace opal
