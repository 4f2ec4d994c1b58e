// Finding, naming and opening OpenCL devices.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#include <CL/opencl.hpp>

#include <string>
#include <vector>

namespace opal {

struct DeviceInfo {
    int index = 0;                    // stable: platforms and devices in the order the loader lists them
    std::string platform, name, vendor, type /* cpu gpu accelerator */, version, driver;
    unsigned long long memory = 0, max_allocation = 0; // bytes
    unsigned compute_units = 0;
    bool fp64 = false;
    int native_lanes = 1;             // 1 on a GPU, else the native float vector width: 1, 4, 8 or 16
    std::string problem;              // why the platform or device could not be asked ("crashed", "timed out"), else empty
};

// Asks every platform in a process of its own (this binary with the hidden command `probe-platform N`), so that one that
// crashes or hangs costs its line and nothing else.
std::vector<DeviceInfo> list_devices();

// The device `render` takes: `wanted` is an index, "cpu", "gpu" or part of a name; empty: the default, with the reason.
struct DevicePick { DeviceInfo info; std::string reason; };
DevicePick pick_device(const std::string &wanted, const std::vector<DeviceInfo> &devices); // Error naming what there is

struct Device {
    DeviceInfo info;
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue; // in order, profiling on
};
Device open_device(const DeviceInfo &info);

} // namespace opal
