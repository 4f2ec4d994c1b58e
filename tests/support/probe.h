// The kernels' functions one by one (host/probe/kernel_probe.h), on the device that tests run on.
#pragma once

#include "probe/kernel_probe.h"
#include "support/device.h"

namespace opal::test {

inline KernelProbe probe_of(const FlatScene &scene, int lanes, const Sources &sources) {
    BuildOptions build;
    build.lanes = lanes;
    return KernelProbe(device(), scene, build, sources);
}

inline std::string at_width(int lanes) { return " at " + std::to_string(lanes) + " lanes"; }

} // namespace opal::test
