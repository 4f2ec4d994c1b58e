// Asking a driver what it offers from a process of its own: a driver that crashes or hangs takes only that process along.
#pragma once

#include "device/context.h"

#include <filesystem>

namespace opal {

// The .icd files that the OpenCL loader would read, by name ($OCL_ICD_VENDORS or /etc/OpenCL/vendors). One empty path where
// there is no such folder: the loader is then asked for whatever it finds.
std::vector<std::filesystem::path> find_drivers();

// What one driver says, asked by starting `opal probe-platform ICD`. A driver that ends otherwise than by itself within
// time_limit seconds yields what it had said, and a line with `problem`. All drivers are asked at the same time.
std::vector<DeviceInfo> probe_drivers(const std::vector<std::filesystem::path> &drivers, double time_limit);

// The other side: loads the driver into this process and prints a line for each device.
void print_probe(const std::string &icd);

// The binary to start; this process's own by default. Tests are not `opal`, so they say where it is.
void set_probe_binary(const std::filesystem::path &binary);
const std::filesystem::path &own_binary();

} // namespace opal
