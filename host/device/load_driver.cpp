#include "device/load_driver.h"

#include <algorithm>
#include <cstdlib>

namespace opal {

namespace {

std::string type_name(cl_device_type type) {
    return type & CL_DEVICE_TYPE_GPU ? "gpu" : type & CL_DEVICE_TYPE_CPU ? "cpu" : "accelerator";
}

// How many paths a work-item should carry: the widest of 1, 4, 8, 16 that the device's float vectors fill.
int lanes_of(const DeviceInfo &info, cl_uint vector_width) {
    if (info.type == "gpu")
        return 1;
    return vector_width >= 16 ? 16 : vector_width >= 8 ? 8 : vector_width >= 4 ? 4 : 1;
}

// Some drivers pad names with blanks or end them with a zero.
std::string trimmed(std::string text) {
    text.erase(std::remove(text.begin(), text.end(), '\0'), text.end());
    const size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

void describe(const cl::Device &device, DeviceInfo &info) {
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.vendor = trimmed(device.getInfo<CL_DEVICE_VENDOR>());
    info.type = type_name(device.getInfo<CL_DEVICE_TYPE>());
    info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>());
    info.driver = trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.max_allocation = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    info.fp64 = device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
    info.native_lanes = lanes_of(info, device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>());
    if (!device.getInfo<CL_DEVICE_AVAILABLE>())
        info.problem = "not available";
    else if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>())
        info.problem = "has no compiler";
}

std::string problem_of(const cl::Error &error) { return std::string(error.what()) + " failed: " + cl_error_name(error.err()); }

} // namespace

void for_each_device(const std::string &icd, const std::function<void(const DeviceInfo &, const cl::Device &)> &use) {
    if (!icd.empty())
        setenv("OCL_ICD_VENDORS", icd.c_str(), 1); // read when the loader is first called
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error &error) {
        constexpr int no_platform = -1001; // CL_PLATFORM_NOT_FOUND_KHR
        if (error.err() != no_platform)
            throw;
    }
    for (size_t p = 0; p < platforms.size(); ++p) {
        DeviceInfo base;
        base.icd = icd;
        base.platform_place = static_cast<int>(p);
        std::vector<cl::Device> devices;
        try {
            base.platform = trimmed(platforms[p].getInfo<CL_PLATFORM_NAME>());
            platforms[p].getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error &error) {
            base.problem = error.err() == CL_DEVICE_NOT_FOUND ? "has no device" : problem_of(error);
            use(base, cl::Device());
        }
        for (size_t d = 0; d < devices.size(); ++d) {
            DeviceInfo info = base;
            info.device_place = static_cast<int>(d);
            try {
                describe(devices[d], info);
            } catch (const cl::Error &error) {
                info.problem = problem_of(error);
            }
            use(info, devices[d]);
        }
    }
}

} // namespace opal
