// Asking a driver what it offers from a process of its own: a driver that crashes or hangs takes only that process
// along.
#pragma once

#include "device/context.h"

#include <filesystem>

namespace opal {

struct Driver {
    std::string name;    // its .icd file or, without one, its library; empty: whatever the loader finds
    std::string library; // as dlopen takes it; empty where the .icd file names none
};

// The drivers that OpenCL loaders would load: the libraries in $OCL_ICD_FILENAMES (Khronos's loader), then what
// $OCL_ICD_VENDORS names: a folder of .icd files or, as ocl-icd has it, one such file or a library. Without it the .icd
// files in $OPENCL_VENDOR_PATH or /etc/OpenCL/vendors, by name. Where there are none, one Driver without a name.
std::vector<Driver> find_drivers();

// What each driver says, asked by starting `opal probe-platform LIBRARY`. A driver that ends otherwise than by itself
// within time_limit seconds yields what it had said, and a line with `problem`. All drivers are asked at the same time.
// What was found under two names is listed once.
std::vector<DeviceInfo> probe_drivers(const std::vector<Driver> &drivers, double time_limit);

// The other side: loads the driver into this process and prints a line for each device.
void print_probe(const std::string &library);

// The binary to start; this process's own by default. Tests are not `opal`, so they say where it is.
void set_probe_binary(const std::filesystem::path &binary);
const std::filesystem::path &own_binary();

} // namespace opal
