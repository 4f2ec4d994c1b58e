// Queries of drivers. Each driver is asked in a process of its own, as it may crash, hang or print.
#pragma once

#include "device/context.h"

#include <filesystem>

namespace opal {

struct Driver {
    std::string name;      // its .icd file or, without one, its library; empty: whatever the loader finds
    std::string library;   // as dlopen takes it; empty where the .icd file names none
    std::string problem{}; // why it names none
};

// The drivers that OpenCL loaders would load, in this order: the libraries in $OCL_ICD_FILENAMES (Khronos's loader);
// then $OCL_ICD_VENDORS, a folder of .icd files or, with ocl-icd, one such file or a library; if that is not set, the
// .icd files in $OPENCL_VENDOR_PATH or /etc/OpenCL/vendors, by name. If there are none, one Driver without a name.
std::vector<Driver> find_drivers();

// The OpenCL loader that this process uses, by the path it was found at.
std::string loader_path();

// The devices of all drivers, each asked by `opal probe-platform LIBRARY`, all at the same time. A driver that crashes
// or takes more than time_limit seconds gives the devices that it had listed, and one with `problem`. A device that was
// found under two names is listed once. ask_all: false passes over a driver that did not answer within the last hour,
// with a problem that says so.
std::vector<DeviceInfo> probe_drivers(const std::vector<Driver> &drivers, double time_limit, bool ask_all = true);

// Loads the driver into this process and answers a line for each device (the command probe-platform): to the process
// that started it, and ends this one, or else to stdout.
void answer_probe(const std::string &library, bool to_parent);

// Sets the binary to start, by default that of this process. Tests set it, as they are not `opal`.
void set_probe_binary(const std::filesystem::path &binary);
const std::filesystem::path &own_binary();

} // namespace opal
