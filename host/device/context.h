// OpenCL devices: listing, picking and opening them. Includes no header of OpenCL, which takes 2 s a file to compile.
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
    unsigned vector_width = 1; // floats, by the driver
    int native_lanes = 1;      // 1 on a GPU, else the widest of 1, 4, 8 and 16 that fits vector_width
    unsigned threads = 0;      // compute units to open of a CPU device; 0: all
    std::string library;       // the driver's, by the path it was found at; empty: whatever the loader finds
    int platform_place = 0, device_place = 0; // indices in the list of that driver alone
    std::string problem; // why the platform or device could not be asked ("crashed", "timed out"), else empty
};

// Work-items of a group, the same for renders and for all checks of a device: a driver's functions may give other bits
// in groups of another size (Intel's rsqrt in groups below 8).
inline size_t group_size(const DeviceInfo &info) { return info.type == "gpu" ? 64 : 1; }

// All devices. Every driver is asked in a process of its own (device/ask_driver.h), all at once: one that crashes or
// hangs costs one line of the list, and a warning if it hangs. time_limit: seconds for all. ask_all: false passes over
// those that hung within the last hour.
std::vector<DeviceInfo> list_devices(double time_limit = 20, bool ask_all = false);

// The device `render` takes: `wanted` is an index, "cpu", "gpu" or part of a name; empty: the default, with the reason.
struct DevicePick {
    DeviceInfo info;
    std::string reason;
};
std::string text_of(const DevicePick &pick); // "NAME (driver VERSION; REASON)"
DevicePick pick_device(const std::string &wanted, const std::vector<DeviceInfo> &devices); // Error naming what there is

// The same device with so many of its compute units, which are the threads of a CPU device. Error where there are not
// so many, and for other devices.
DeviceInfo with_threads(DeviceInfo info, unsigned threads);

// The width of a kernel on that device: `wanted`, or the device's own where that is 0, which doubles halve (4 at
// least). Error where the device has no doubles and the math asks for them.
int lanes_for(const DeviceInfo &info, int wanted, MathMode math);

struct DeviceHandles; // device/opencl.h

struct Device {
    DeviceInfo info;
    std::shared_ptr<const DeviceHandles> handles; // a copy shares the device
};
// Loads the driver of that device, and no other, into this process. Error that names the device and the OpenCL error.
Device open_device(const DeviceInfo &info);

} // namespace opal
