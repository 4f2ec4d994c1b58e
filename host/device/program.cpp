#include "device/program.h"

#include "base/error.h"
#include "base/log.h"
#include "base/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

namespace opal {

namespace {

// $OPAL_KERNEL_FLAGS adds flags, for experiments. The tests set -Werror by it.
std::string build_flags(const BuildOptions &options) {
    std::string flags = "-cl-std=CL1.2";
    if (options.math == MathMode::fast)
        flags += " -cl-fast-relaxed-math";
    if (const char *more = std::getenv("OPAL_KERNEL_FLAGS"); more && *more)
        flags += std::string(" ") + more;
    return flags;
}

// Most drivers report places by the #line directives: "cl/kernels/render.cl:40:18: ...".
std::string log_of(const cl::Program &program, const cl::Device &device) {
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    } catch (const cl::Error &error) {
        return "(the driver gives no log: " + cl_error_name(error.err()) + ")";
    }
}

} // namespace

cl::Program build_program(const Device &device, const std::string &text, const BuildOptions &options, double *seconds) {
    const auto start = std::chrono::steady_clock::now();
    auto &programs = device.handles->programs;
    const std::string key = build_flags(options) + '\n' + text;
    if (const auto known = std::ranges::find(programs, key, &std::pair<std::string, cl::Program>::first);
        known != programs.end() && options.cache_salt.empty()) {
        std::rotate(programs.begin(), known, known + 1);
        if (seconds)
            *seconds = 0;
        return programs.front().second;
    }
    cl::Program program = with_device(device.info, [&] { return cl::Program(device.handles->context, text); });
    try {
        program.build({device.handles->device}, build_flags(options).c_str());
    } catch (const cl::Error &error) {
        std::vector<std::string> lines = lines_of(log_of(program, device.handles->device));
        lines.insert(lines.begin(),
                     fmt::format("{} (driver {}): the kernels do not build: {}; flags {}", device.info.name,
                                 device.info.driver, cl_error_name(error.err()), build_flags(options)));
        throw ErrorList(lines);
    }
    const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    detail(fmt::format("build   {} for {} in {:.3g} s; flags {}; the driver says:\n{}",
                       options.kernels.empty() ? "the renderer" : options.kernels, device.info.name, taken,
                       build_flags(options), log_of(program, device.handles->device)));
    if (seconds)
        *seconds = taken;
    constexpr size_t most_programs = 4; // a renderer has two
    programs.insert(programs.begin(), {key, program});
    programs.resize(std::min(programs.size(), most_programs));
    return program;
}

} // namespace opal
