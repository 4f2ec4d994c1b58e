// OpenCL's C++ header, and the handles of an open device. Only files that make buffers, build programs or launch
// kernels include this, as the header is slow to compile.
#pragma once

#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_ENABLE_EXCEPTIONS
#include <CL/opencl.hpp>

#include "base/error.h"
#include "device/context.h"

namespace opal {

class CachedProgram;

struct BuiltProgram {
    std::string key; // flags and text
    cl::Program program;
    std::shared_ptr<CachedProgram> file; // in the cache of kernels; null: it is not to be kept
};

struct DeviceHandles {
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue; // in order, profiling on
    // The programs built last, the latest first: strategies that share one do not build it again.
    mutable std::vector<BuiltProgram> programs = {};
};

// "CL_OUT_OF_RESOURCES" for -5; "OpenCL error -9999" for what OpenCL 1.2 does not name.
std::string cl_error_name(int code);

// Runs `body`; a cl::Error in it becomes an Error "DEVICE: CALL failed: CL_NAME".
template <class Body> auto with_device(const DeviceInfo &info, Body &&body) {
    try {
        return body();
    } catch (const cl::Error &error) {
        throw Error(info.name + ": " + error.what() + " failed: " + cl_error_name(error.err()));
    }
}

} // namespace opal
