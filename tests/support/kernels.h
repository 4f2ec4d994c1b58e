// Kernels that a test runs by itself: built, given arguments, and read back.
#pragma once

#include "device/buffers.h"
#include "device/program.h"
#include "support/device.h"

namespace opal::test {

// Builds `kernels` ("tests/warps.cl", "kernels/render.cl"), kept for the next test that asks for the same.
cl::Program program(const std::string &kernels, int lanes, const Features &features = all_features(),
                    MathMode math = MathMode::precise);

// The same from a text in the test itself, which may #include what is below cl/.
cl::Program program_of(const std::string &text, int lanes, const Features &features = all_features(),
                       MathMode math = MathMode::precise);

// The same with other sources below cl/.
cl::Program program_from(const Sources &sources, const std::string &text, int lanes,
                         const Features &features = all_features(), MathMode math = MathMode::precise);

// A kernel's output of `count` values: an argument of run(), which read() then copies back.
template <class T> struct Output {
    size_t count;
    cl::Buffer buffer = make_zeros<T>(device(), count, "a test's output");
    explicit Output(size_t n) : count(n) {}
    std::vector<T> read() const { return read_buffer<T>(device(), buffer, count); }
};

// Runs kernel `name` over work_items and waits. Arguments: Output, std::vector (a read-only table), or a plain value.
template <class... Arguments>
void run(const cl::Program &program, const std::string &name, size_t work_items, const Arguments &...arguments) {
    with_device(device().info, [&] {
        cl::Kernel kernel(program, name.c_str());
        std::vector<cl::Buffer> inputs; // clSetKernelArg does not retain
        cl_uint place = 0;
        const auto set = [&](const auto &argument) {
            if constexpr (requires { argument.buffer; })
                kernel.setArg(place++, argument.buffer);
            else if constexpr (requires {
                                   argument.data();
                                   argument.size();
                               })
                kernel.setArg(place++, inputs.emplace_back(make_table(device(), argument, "a test's input")));
            else
                kernel.setArg(place++, argument);
        };
        (set(arguments), ...);
        const LaunchScope launching(device(), kernel);
        device().handles->queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(work_items), cl::NullRange);
        return device().handles->queue.finish();
    });
}

} // namespace opal::test
