#include "device/buffers.h"

#include <fmt/format.h>

namespace opal {

namespace {

[[noreturn]] void no_room(const Device &device, unsigned long long bytes, const std::string &what) {
    throw Error(fmt::format("{}: no room for {}: {} wanted; the device has {} in all and gives at most {} to one buffer",
                            device.info.name, what, bytes_text(bytes), bytes_text(device.info.memory),
                            bytes_text(device.info.max_allocation)));
}

} // namespace

std::string bytes_text(unsigned long long bytes) {
    static const char *const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
    double value = static_cast<double>(bytes);
    int unit = 0;
    for (; value >= 1024 && unit < 4; ++unit)
        value /= 1024;
    return unit == 0 ? fmt::format("{} bytes", bytes) : fmt::format("{:.1f} {}", value, units[unit]);
}

void check_room(const Device &device, unsigned long long bytes, const std::string &what) {
    if (bytes > device.info.memory)
        no_room(device, bytes, what);
}

cl::Buffer make_buffer(const Device &device, cl_mem_flags flags, unsigned long long bytes, const void *data,
                       const std::string &what) {
    if (bytes > device.info.max_allocation || bytes > device.info.memory)
        no_room(device, bytes, what);
    try {
        // COPY_HOST_PTR only reads the data, but OpenCL's signature is not const.
        return cl::Buffer(device.context, flags | (data ? CL_MEM_COPY_HOST_PTR : 0), bytes, const_cast<void *>(data));
    } catch (const cl::Error &error) {
        if (error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE || error.err() == CL_OUT_OF_RESOURCES ||
            error.err() == CL_OUT_OF_HOST_MEMORY || error.err() == CL_INVALID_BUFFER_SIZE)
            no_room(device, bytes, what);
        return with_device(device.info, [&]() -> cl::Buffer { throw error; });
    }
}

} // namespace opal
