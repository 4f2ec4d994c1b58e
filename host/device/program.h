// A program, compiled for a device, and launches of its kernels.
#pragma once

#include "device/opencl.h"
#include "device/sources.h"
#include "device/work_folder.h"

namespace opal {

// Compiles with -cl-std=CL1.2, -cl-fast-relaxed-math for MathMode::fast, and $OPAL_KERNEL_FLAGS. What the driver
// remarks is told by --verbose. A program that was among the last few is not built again. Error: device, driver, the
// whole build log.
cl::Program build_program(const Device &device, const std::string &text, const BuildOptions &options,
                          double *seconds = nullptr);

// Lives while a kernel is launched and until it has run: drivers finish compiling at the first launch of a shape. What
// they have compiled is then kept in the cache.
class LaunchScope {
public:
    LaunchScope(const Device &device, const cl::Kernel &kernel);
    ~LaunchScope();
    LaunchScope(const LaunchScope &) = delete;
    LaunchScope &operator=(const LaunchScope &) = delete;

private:
    const DriverScope driver_;
    std::shared_ptr<CachedProgram> file_; // of the kernel's program; null: it is not kept
    bool first_ = false;                  // it comes from the cache, and is launched for the first time
    int exceptions_;                      // in flight at the start
};

} // namespace opal
