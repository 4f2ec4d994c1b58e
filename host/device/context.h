// Finding, naming and opening OpenCL devices.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#include <CL/opencl.hpp>

#include "base/error.h"

#include <string>
#include <vector>

namespace opal {

struct DeviceInfo {
    int index = 0; // stable: platforms and devices in the order the loader lists them
    std::string platform, name, vendor, type /* cpu gpu accelerator */, version, driver;
    unsigned long long memory = 0, max_allocation = 0; // bytes
    unsigned compute_units = 0;
    bool fp64 = false;
    unsigned vector_width = 1; // floats, as the driver says it
    int native_lanes = 1;      // 1 on a GPU, else the widest of 1, 4, 8 and 16 that fits vector_width
    std::string library;       // the driver's, by the path it was found at; empty: whatever the loader finds
    int platform_place = 0, device_place = 0; // among what that driver alone lists
    std::string problem; // why the platform or device could not be asked ("crashed", "timed out"), else empty
};

// Work-items of a group. All that measures a device takes the size that renders, as a driver's functions may have other
// bits in another (Intel's rsqrt in groups below 8).
inline size_t group_size(const DeviceInfo &info) { return info.type == "gpu" ? 64 : 1; }

// Asks every driver in a process of its own (device/ask_driver.h), all at once, so that one that crashes or hangs costs
// its line and nothing else. time_limit: seconds for each.
std::vector<DeviceInfo> list_devices(double time_limit = 20);

// The device `render` takes: `wanted` is an index, "cpu", "gpu" or part of a name; empty: the default, with the reason.
struct DevicePick {
    DeviceInfo info;
    std::string reason;
};
DevicePick pick_device(const std::string &wanted, const std::vector<DeviceInfo> &devices); // Error naming what there is

struct Device {
    DeviceInfo info;
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue; // in order, profiling on
};
// Loads that device's driver and no other into this process. Error naming the device and the OpenCL error.
Device open_device(const DeviceInfo &info);

// "CL_OUT_OF_RESOURCES" for -5; "OpenCL error -9999" for what OpenCL 1.2 does not name.
std::string cl_error_name(int code);

// Runs `body`; a cl::Error in it becomes an Error "DEVICE: CALL failed: CL_NAME".
template <class Body> auto with_device(const DeviceInfo &info, Body &&body) {
    try {
        return body();
    } catch (const cl::Error &error) {
        throw Error(info.name + ": " + error.what() + " failed: " + cl_error_name(error.err()));
    }
}

} // namespace opal
