#include "device/load_driver.h"

#include "base/environment.h"

#include <algorithm>
#include <optional>

#include <dlfcn.h>
#include <link.h>

namespace opal {

namespace {

std::string type_name(cl_device_type type) {
    return type & CL_DEVICE_TYPE_GPU ? "gpu" : type & CL_DEVICE_TYPE_CPU ? "cpu" : "accelerator";
}

// The widest of 1, 4, 8 and 16 lanes that the device's float vectors fill.
int lanes_of(const DeviceInfo &info) {
    if (info.type == "gpu")
        return 1;
    return info.vector_width >= 16 ? 16 : info.vector_width >= 8 ? 8 : info.vector_width >= 4 ? 4 : 1;
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
    info.vector_width = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    info.native_lanes = lanes_of(info);
    if (!device.getInfo<CL_DEVICE_AVAILABLE>())
        info.problem = "not available";
    else if (!device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>())
        info.problem = "has no compiler";
}

// Makes the OpenCL loader load this library and no other, by its environment, which it reads when it is first called.
// Three loaders are in use:
// - Khronos's takes libraries from OCL_ICD_FILENAMES, and from OCL_ICD_VENDORS a folder of .icd files (icd.c,
// icd_linux.c);
// - NVIDIA's, made from it, wants a slash at the end of that folder;
// - ocl-icd does not know OCL_ICD_FILENAMES, but an OCL_ICD_VENDORS that is no folder and no .icd file is the library
// itself (libOpenCL(7)).
// The library's name in both variables is understood by each, and needs no folder to be written.
std::vector<cl::Platform> platforms_of(const std::string &library) {
    std::optional<ScopedVariable> vendors, file_names;
    if (!library.empty()) {
        vendors.emplace("OCL_ICD_VENDORS", library);
        file_names.emplace("OCL_ICD_FILENAMES", library);
    }
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error &error) {
        constexpr int no_platform = -1001; // CL_PLATFORM_NOT_FOUND_KHR
        if (error.err() != no_platform)
            throw;
    }
    return platforms;
}

// Loaders pass over a library without platforms and do not say why.
std::string why_no_platform(const std::string &library) {
    return dlopen(library.c_str(), RTLD_NOW) ? "offers no platform"
                                             : std::string("cannot be loaded (") + dlerror() + ")";
}

std::string problem_of(const cl::Error &error) {
    return std::string(error.what()) + " failed: " + cl_error_name(error.err());
}

} // namespace

std::string library_path(const std::string &library) {
    void *const handle = library.empty() ? nullptr : dlopen(library.c_str(), RTLD_LAZY | RTLD_NOLOAD);
    if (!handle)
        return {};
    link_map *map = nullptr;
    std::string path = dlinfo(handle, RTLD_DI_LINKMAP, &map) == 0 ? map->l_name : "";
    dlclose(handle);
    return path;
}

void for_each_device(const std::string &library,
                     const std::function<void(const DeviceInfo &, const cl::Device &)> &use) {
    const std::vector<cl::Platform> platforms = platforms_of(library);
    DeviceInfo driver;
    if (platforms.empty() && !library.empty()) {
        driver.library = library;
        driver.problem = why_no_platform(library);
        use(driver, cl::Device());
    }
    driver.library = library_path(library); // empty: the loader ignored its environment
    for (size_t p = 0; p < platforms.size(); ++p) {
        DeviceInfo base = driver;
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
