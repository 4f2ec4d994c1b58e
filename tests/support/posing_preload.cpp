// A library that tests preload into opal, so that a CPU device poses as another: the host's code for GPUs and for
// poorer devices then runs without one. $OPAL_POSE lists what it claims: "gpu" (its type), "vectors-of-2" (floats),
// "no-fp64". The file $OPAL_LAUNCHES gets a line for each launch: the kernel and the size of its work-groups.
#include <CL/cl.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include <dlfcn.h>

namespace {

// The function of this name that would be called without this library.
template <class Function> Function *next(const char *name, Function *) {
    return reinterpret_cast<Function *>(dlsym(RTLD_NEXT, name));
}

bool poses_as(std::string_view what) {
    const char *const given = std::getenv("OPAL_POSE");
    return given && std::string_view(given).find(what) != std::string_view::npos;
}

// Crosses out an extension, so that the list keeps its length.
void hide(char *extensions, const char *name) {
    if (char *const at = std::strstr(extensions, name))
        std::memset(at, 'x', std::strlen(name));
}

} // namespace

extern "C" cl_int clGetDeviceInfo(cl_device_id device, cl_device_info what, size_t room, void *value, size_t *size) {
    static const auto real = next("clGetDeviceInfo", clGetDeviceInfo);
    const cl_int code = real(device, what, room, value, size);
    if (code != CL_SUCCESS || !value)
        return code;
    if (what == CL_DEVICE_TYPE && poses_as("gpu"))
        *static_cast<cl_device_type *>(value) = CL_DEVICE_TYPE_GPU;
    if (what == CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT && poses_as("vectors-of-2"))
        *static_cast<cl_uint *>(value) = 2;
    if (what == CL_DEVICE_EXTENSIONS && poses_as("no-fp64"))
        hide(static_cast<char *>(value), "cl_khr_fp64");
    return code;
}

extern "C" cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                                         const size_t *offset, const size_t *global, const size_t *local, cl_uint waits,
                                         const cl_event *wait_list, cl_event *event) {
    static const auto real = next("clEnqueueNDRangeKernel", clEnqueueNDRangeKernel);
    static FILE *const log = std::getenv("OPAL_LAUNCHES") ? std::fopen(std::getenv("OPAL_LAUNCHES"), "a") : nullptr;
    char name[100] = "";
    if (log && clGetKernelInfo(kernel, CL_KERNEL_FUNCTION_NAME, sizeof name, name, nullptr) == CL_SUCCESS) {
        std::fprintf(log, "%s %zu\n", name, local ? *local : 0);
        std::fflush(log);
    }
    return real(queue, kernel, dimensions, offset, global, local, waits, wait_list, event);
}
