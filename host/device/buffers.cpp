#include "device/buffers.h"

#include "base/units.h"

#include <fmt/format.h>

#include <cstring>

namespace opal {

namespace {

[[noreturn]] void no_room(const Device &device, unsigned long long bytes, const std::string &what) {
    throw Error(fmt::format(
        "{}: no room for {}: {} wanted; the device has {} in all and gives at most {} to one buffer", device.info.name,
        what, bytes_text(bytes), bytes_text(device.info.memory), bytes_text(device.info.max_allocation)));
}

// A CPU device's buffer, in huge pages. Mapped, such a buffer is the memory that kernels see.
cl::Buffer make_cpu_buffer(const Device &device, cl_mem_flags flags, unsigned long long bytes, const void *data) {
    cl::Buffer buffer(device.handles->context, flags, bytes);
    void *const memory =
        device.handles->queue.enqueueMapBuffer(buffer, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0, bytes);
    advise_huge_pages(memory, bytes);
    if (data)
        std::memcpy(memory, data, bytes);
    device.handles->queue.enqueueUnmapMemObject(buffer, memory);
    device.handles->queue.finish();
    return buffer;
}

} // namespace

void check_room(const Device &device, unsigned long long bytes, const std::string &what) {
    if (bytes > device.info.memory)
        no_room(device, bytes, what);
}

cl::Buffer make_buffer(const Device &device, cl_mem_flags flags, unsigned long long bytes, const void *data,
                       const std::string &what) {
    if (bytes > device.info.max_allocation || bytes > device.info.memory)
        no_room(device, bytes, what);
    try {
        const bool in_place = flags & CL_MEM_USE_HOST_PTR;
        if (shares_memory(device) && !in_place)
            return make_cpu_buffer(device, flags, bytes, data);
        // The data is only read, but OpenCL's signature is not const.
        return cl::Buffer(device.handles->context, flags | (data && !in_place ? CL_MEM_COPY_HOST_PTR : 0), bytes,
                          const_cast<void *>(data));
    } catch (const cl::Error &error) {
        if (error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE || error.err() == CL_OUT_OF_RESOURCES ||
            error.err() == CL_OUT_OF_HOST_MEMORY || error.err() == CL_INVALID_BUFFER_SIZE)
            no_room(device, bytes, what);
        return with_device(device.info, [&]() -> cl::Buffer { throw error; });
    }
}

} // namespace opal
