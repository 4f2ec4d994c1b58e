// Buffers in the device's memory. A buffer that does not fit is an Error that names the device, its purpose, and the
// bytes wanted and available.
#pragma once

#include "base/large_vector.h"
#include "device/opencl.h"

#include <vector>

namespace opal {

// Throws Error unless `bytes` in all (of several buffers) fit the device's memory. what: "the film and its samples".
void check_room(const Device &device, unsigned long long bytes, const std::string &what);

// Whether the device's memory is the host's.
inline bool shares_memory(const Device &device) { return device.info.type == "cpu"; }

// One buffer of `bytes`, filled from `data` unless that is nullptr. flags: CL_MEM_READ_ONLY, CL_MEM_READ_WRITE, ...;
// with CL_MEM_USE_HOST_PTR the buffer is `data` itself.
cl::Buffer make_buffer(const Device &device, cl_mem_flags flags, unsigned long long bytes, const void *data,
                       const std::string &what);

// A read-only table, copied from a vector. OpenCL has no empty buffers: an empty table gets room for one element,
// unwritten.
template <class Rows> cl::Buffer make_table(const Device &device, const Rows &rows, const std::string &what) {
    const bool empty = rows.empty();
    return make_buffer(device, CL_MEM_READ_ONLY, sizeof(rows[0]) * (empty ? 1 : rows.size()),
                       empty ? nullptr : rows.data(), what);
}

// The same, but a CPU device reads the memory of a large vector: that must stay as it is while the buffer is used.
template <class T> cl::Buffer share_table(const Device &device, const LargeVector<T> &rows, const std::string &what) {
    if (!is_large(sizeof(T) * rows.size()) || !shares_memory(device))
        return make_table(device, rows, what);
    return make_buffer(device, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, sizeof(T) * rows.size(), rows.data(), what);
}

// Room for `count` elements that kernels write, all bytes 0 at first.
template <class T> cl::Buffer make_zeros(const Device &device, size_t count, const std::string &what) {
    cl::Buffer buffer = make_buffer(device, CL_MEM_READ_WRITE, sizeof(T) * (count ? count : 1), nullptr, what);
    with_device(device.info, [&] {
        return device.handles->queue.enqueueFillBuffer(buffer, cl_uchar(0), 0, sizeof(T) * (count ? count : 1));
    });
    return buffer;
}

// The first `count` elements, read back after everything queued before has run.
template <class T> std::vector<T> read_buffer(const Device &device, const cl::Buffer &buffer, size_t count) {
    std::vector<T> rows(count);
    if (count)
        with_device(device.info, [&] {
            return device.handles->queue.enqueueReadBuffer(buffer, CL_TRUE, 0, sizeof(T) * count, rows.data());
        });
    return rows;
}

// Calls read(elements) with the first `count` elements after everything queued before has run. A CPU device gives its
// own memory, without a copy.
template <class T, class Read>
void read_mapped(const Device &device, const cl::Buffer &buffer, size_t count, Read read) {
    const cl::CommandQueue &queue = device.handles->queue;
    void *const memory = with_device(
        device.info, [&] { return queue.enqueueMapBuffer(buffer, CL_TRUE, CL_MAP_READ, 0, sizeof(T) * count); });
    read(static_cast<const T *>(memory));
    with_device(device.info, [&] {
        queue.enqueueUnmapMemObject(buffer, memory);
        return queue.finish();
    });
}

} // namespace opal
