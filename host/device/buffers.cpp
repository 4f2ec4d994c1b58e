#include "device/buffers.h"

#include "base/units.h"

#include <fmt/format.h>

#include <cstring>
#include <sys/mman.h>

namespace opal {

namespace {

[[noreturn]] void no_room(const Device &device, unsigned long long bytes, const std::string &what) {
    throw Error(fmt::format(
        "{}: no room for {}: {} wanted; the device has {} in all and gives at most {} to one buffer", device.info.name,
        what, bytes_text(bytes), bytes_text(device.info.memory), bytes_text(device.info.max_allocation)));
}

// A CPU device's buffer, in huge pages where the system gives them on request: a walk through a large tree then spends
// a tenth less on finding its pages. Mapped, such a buffer is the memory that kernels see.
cl::Buffer make_cpu_buffer(const Device &device, cl_mem_flags flags, unsigned long long bytes, const void *data) {
    constexpr size_t huge_page = 2u << 20;
    cl::Buffer buffer(device.handles->context, flags, bytes);
    char *const memory = static_cast<char *>(
        device.handles->queue.enqueueMapBuffer(buffer, CL_TRUE, CL_MAP_WRITE_INVALIDATE_REGION, 0, bytes));
    char *const first = memory + (huge_page - reinterpret_cast<uintptr_t>(memory) % huge_page) % huge_page;
    if (first + huge_page <= memory + bytes)
        madvise(first, size_t(memory + bytes - first) / huge_page * huge_page,
                MADV_HUGEPAGE); // advice: no harm where it is refused
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
        if (device.info.type == "cpu")
            return make_cpu_buffer(device, flags, bytes, data);
        // COPY_HOST_PTR only reads the data, but OpenCL's signature is not const.
        return cl::Buffer(device.handles->context, flags | (data ? CL_MEM_COPY_HOST_PTR : 0), bytes,
                          const_cast<void *>(data));
    } catch (const cl::Error &error) {
        if (error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE || error.err() == CL_OUT_OF_RESOURCES ||
            error.err() == CL_OUT_OF_HOST_MEMORY || error.err() == CL_INVALID_BUFFER_SIZE)
            no_room(device, bytes, what);
        return with_device(device.info, [&]() -> cl::Buffer { throw error; });
    }
}

} // namespace opal
