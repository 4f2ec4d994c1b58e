// A program, compiled for a device.
#pragma once

#include "device/opencl.h"
#include "device/sources.h"

namespace opal {

// Compiles with -cl-std=CL1.2, -cl-fast-relaxed-math for MathMode::fast, and $OPAL_KERNEL_FLAGS. What the driver
// remarks is told by --verbose. A program that was among the last few is not built again. Error: device, driver, the
// whole build log.
cl::Program build_program(const Device &device, const std::string &text, const BuildOptions &options,
                          double *seconds = nullptr);

} // namespace opal
