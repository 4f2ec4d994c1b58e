// Finding, naming and opening OpenCL devices. Needs no header of OpenCL, whose price is 2 s a file.
#pragma once

#include "scene/strategy.h"

#include <memory>
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
std::string text_of(const DevicePick &pick); // "NAME (driver VERSION; REASON)"
DevicePick pick_device(const std::string &wanted, const std::vector<DeviceInfo> &devices); // Error naming what there is

// The width of a kernel on that device: `wanted`, or the device's own where that is 0, which doubles halve (4 at
// least). Error where the device has no doubles and the math asks for them.
int lanes_for(const DeviceInfo &info, int wanted, MathMode math);

struct DeviceHandles; // device/opencl.h

struct Device {
    DeviceInfo info;
    std::shared_ptr<const DeviceHandles> handles; // a copy shares the device
};
// Loads that device's driver and no other into this process. Error naming the device and the OpenCL error.
Device open_device(const DeviceInfo &info);

} // namespace opal
