#include "device/context.h"

#include "base/environment.h"
#include "device/ask_driver.h"
#include "device/load_driver.h"
#include "device/work_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace opal {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool contains(const std::string &text, const std::string &part) {
    return lower(text).find(lower(part)) != std::string::npos;
}

// Mesa's software rasterisers call themselves GPUs or CPUs, and end long loops early (scripts/README.md).
bool is_software_rasteriser(const DeviceInfo &info) {
    return contains(info.name, "llvmpipe") || contains(info.name, "softpipe") || contains(info.name, "swrast");
}

std::string list_of(const std::vector<DeviceInfo> &devices) {
    std::vector<std::string> lines;
    for (const DeviceInfo &d : devices)
        lines.push_back(d.problem.empty() ? fmt::format("{} ({}, {})", d.index, d.type, d.name)
                                          : fmt::format("{} ({}: {})", d.index, d.platform, d.problem));
    return lines.empty() ? "none (is an OpenCL driver installed? Debian: apt-get install pocl-opencl-icd; "
                           "one without an .icd file: OCL_ICD_FILENAMES=libnvidia-opencl.so.1)"
                         : fmt::format("{}", fmt::join(lines, ", "));
}

DevicePick default_device(const std::vector<DeviceInfo> &devices) {
    const DeviceInfo *best = nullptr;
    int best_rank = 0;
    for (const DeviceInfo &device : devices) {
        const int rank = !device.problem.empty()          ? 0
                         : is_software_rasteriser(device) ? 1
                         : device.type == "accelerator"   ? 2
                         : device.type == "cpu"           ? 3
                                                          : 4;
        if (rank > best_rank) {
            best = &device;
            best_rank = rank;
        }
    }
    static const char *const reasons[] = {"", "only a software rasteriser was found",
                                          "no GPU and no CPU device was found",
                                          "the first CPU device, as there is no GPU", "the first GPU"};
    if (!best)
        throw Error("no usable OpenCL device; found: " + list_of(devices));
    return {*best, reasons[best_rank]};
}

std::optional<int> as_index(const std::string &text) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() ? std::optional<int>(value) : std::nullopt;
}

// Whether `wanted` means this device, and the reason.
std::optional<std::string> match(const DeviceInfo &device, const std::string &wanted) {
    if (const auto index = as_index(wanted))
        return *index == device.index ? std::optional<std::string>("asked for by index") : std::nullopt;
    if (const std::string type = lower(wanted); type == "cpu" || type == "gpu")
        return device.type == type ? std::optional<std::string>("the first " + type + " device") : std::nullopt;
    if (contains(device.name, wanted) || contains(device.platform, wanted))
        return fmt::format("the first whose name holds \"{}\"", wanted);
    return std::nullopt;
}

} // namespace

std::vector<DeviceInfo> list_devices(double time_limit, bool ask_all) {
    std::vector<DeviceInfo> devices = probe_drivers(find_drivers(), time_limit, ask_all);
    for (size_t i = 0; i < devices.size(); ++i)
        devices[i].index = static_cast<int>(i);
    return devices;
}

std::string text_of(const DevicePick &pick) {
    const unsigned threads = pick.info.threads;
    return fmt::format("{} (driver {}; {}{})", pick.info.name, pick.info.driver, pick.reason,
                       threads ? fmt::format("; {} thread{}", threads, threads == 1 ? "" : "s") : "");
}

DevicePick pick_device(const std::string &wanted, const std::vector<DeviceInfo> &devices) {
    if (wanted.empty())
        return default_device(devices);
    const DeviceInfo *unusable = nullptr;
    for (const DeviceInfo &device : devices)
        if (const auto reason = match(device, wanted)) {
            if (device.problem.empty())
                return {device, *reason};
            unusable = unusable ? unusable : &device;
        }
    if (unusable)
        throw Error(fmt::format("device {} ({}) cannot be used: it {}; available: {}", unusable->index,
                                unusable->platform, unusable->problem, list_of(devices)));
    throw Error(fmt::format("no OpenCL device \"{}\"; available: {}", wanted, list_of(devices)));
}

int lanes_for(const DeviceInfo &info, int wanted, MathMode math) {
    const bool doubles = math == MathMode::double_precision;
    if (doubles && !info.fp64)
        throw Error(
            fmt::format("{} (driver {}): math double makes no sense: the device has no double precision (cl_khr_fp64); "
                        "available: precise, fast",
                        info.name, info.driver));
    if (wanted)
        return wanted;
    return doubles && info.native_lanes > 4 ? info.native_lanes / 2 : info.native_lanes;
}

DeviceInfo with_threads(DeviceInfo info, unsigned threads) {
    if (info.type != "cpu")
        throw UsageError(fmt::format("--threads: {} is no CPU; possible for CPU devices only", info.name));
    if (threads < 1 || threads > info.compute_units)
        throw UsageError(
            fmt::format("--threads: {} is out of range; {} has 1 to {}", threads, info.name, info.compute_units));
    info.threads = info.compute_units = threads;
    return info;
}

namespace {

// A part of the device with that many compute units (device fission, OpenCL 1.2, section 4.3).
cl::Device part_of(cl::Device &device, unsigned units) {
    if (units == device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>())
        return device;
    const cl_device_partition_property counts[] = {CL_DEVICE_PARTITION_BY_COUNTS, cl_device_partition_property(units),
                                                   CL_DEVICE_PARTITION_BY_COUNTS_LIST_END, 0};
    std::vector<cl::Device> parts;
    device.createSubDevices(counts, &parts);
    return parts.at(0);
}

} // namespace

Device open_device(const DeviceInfo &info) {
    return with_device(info, [&] {
        const DriverScope scope;
        const ScopedVariable cache(pocl_cache_variable, WorkFolder::own().driver_files());
        std::optional<cl::Device> found;
        for_each_device(info.library, [&](const DeviceInfo &seen, const cl::Device &device) {
            if (seen.platform_place == info.platform_place && seen.device_place == info.device_place &&
                seen.name == info.name)
                found = device;
        });
        if (!found)
            throw Error(fmt::format("{}: the device is gone since the drivers were asked", info.name));
        if (info.threads)
            found = part_of(*found, info.threads);
        const cl::Context context(*found);
        const cl::CommandQueue queue(context, *found, CL_QUEUE_PROFILING_ENABLE);
        return Device{info, std::make_shared<DeviceHandles>(DeviceHandles{*found, context, queue})};
    });
}

} // namespace opal
