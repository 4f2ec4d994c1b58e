#include "device/program.h"

#include "base/log.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>

namespace opal {

namespace {

// $OPAL_KERNEL_FLAGS: more of them, to try what a driver offers; the tests' -Werror comes by it.
std::string build_flags(const BuildOptions &options) {
    std::string flags = "-cl-std=CL1.2";
    if (options.math == MathMode::fast)
        flags += " -cl-fast-relaxed-math";
    if (const char *more = std::getenv("OPAL_KERNEL_FLAGS"); more && *more)
        flags += std::string(" ") + more;
    return flags;
}

// A call that passes lanes passes them through memory, so every function is inlined: 10 to 15 % of the time of a render
// on PoCL. GPUs' compilers do so unasked. A simulator that knows no inlined code (Oclgrind) is given OPAL_KEEP_CALLS.
constexpr const char *inline_all = "#if defined(__clang__) && __clang_major__ >= 7 && !defined(OPAL_KEEP_CALLS)\n"
                                   "#pragma clang attribute push(__attribute__((always_inline)), apply_to = function)\n"
                                   "#endif\n";
constexpr const char *inline_end = "\n#if defined(__clang__) && __clang_major__ >= 7 && !defined(OPAL_KEEP_CALLS)\n"
                                   "#pragma clang attribute pop\n"
                                   "#endif\n";

// Most drivers report places by the #line directives: "cl/kernels/render.cl:40:18: ...".
std::string log_of(const cl::Program &program, const cl::Device &device) {
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    } catch (const cl::Error &error) {
        return "(the driver gives no log: " + cl_error_name(error.err()) + ")";
    }
}

} // namespace

int lanes_for(const DeviceInfo &info, int wanted, MathMode math) {
    const bool doubles = math == MathMode::double_precision;
    if (doubles && !info.fp64)
        throw Error(
            fmt::format("{} (driver {}): math double makes no sense: the device has no double precision (cl_khr_fp64); "
                        "available: precise, fast",
                        info.name, info.driver));
    if (wanted)
        return wanted;
    return doubles && info.native_lanes > 4 ? info.native_lanes / 2 : info.native_lanes;
}

std::string program_text(const Features &features, const BuildOptions &options, const Sources &sources) {
    std::string text = fmt::format(
        "#define LANES {}\n#define OPAL_DOUBLE {}\n#define OPAL_FAST {}\n#define OPAL_COUNT_TESTS {}\n", options.lanes,
        int(options.math == MathMode::double_precision), int(options.math == MathMode::fast), int(options.count_tests));
    for (const char *stage : {"traversal", "sampling"})
        text += fmt::format("#define OPAL_REPEAT_{} {}\n", stage, int(options.twice == stage));
    if (!options.note.empty())
        text += fmt::format("typedef int opal_note_{};\n", options.note); // drivers see through comments and defines
#define OPAL_FEATURE_ROW(name, shown)                                                                                  \
    text += fmt::format("#define OPAL_HAS_" #name " {}\n", int(features[FEATURE_##name]));
    OPAL_FEATURES
#undef OPAL_FEATURE_ROW
#define OPAL_AXIS_DEFINE(axis, help)                                                                                   \
    text += fmt::format("#define OPAL_AXIS_" #axis " {}\n", features.axes[AXIS_##axis]);
    OPAL_AXES(OPAL_AXIS_DEFINE)
#undef OPAL_AXIS_DEFINE
    const bool specialised =
        features.axes[AXIS_integrator] >= 0; // the general kernel would take half a minute to compile
    const std::string body = sources.expand(options.kernels, options.lanes);
    return specialised ? text + inline_all + body + inline_end : text + body;
}

cl::Program build_program(const Device &device, const std::string &text, const BuildOptions &options, double *seconds) {
    const auto start = std::chrono::steady_clock::now();
    cl::Program program = with_device(device.info, [&] { return cl::Program(device.context, text); });
    try {
        program.build({device.device}, build_flags(options).c_str());
    } catch (const cl::Error &error) {
        throw Error(fmt::format("{} (driver {}): the kernels do not build: {}; flags {}\n{}", device.info.name,
                                device.info.driver, cl_error_name(error.err()), build_flags(options),
                                log_of(program, device.device)));
    }
    const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    detail(fmt::format("build   {} for {} in {:.3g} s; flags {}; the driver says:\n{}", options.kernels,
                       device.info.name, taken, build_flags(options), log_of(program, device.device)));
    if (seconds)
        *seconds = taken;
    return program;
}

} // namespace opal
