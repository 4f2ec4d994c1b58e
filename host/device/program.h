// From features to a compiled program: the text is self-contained, so that drivers cache it rightly.
#pragma once

#include "device/context.h"
#include "flatten/flat_scene.h"

#include <map>

namespace opal {

struct BuildOptions {
    int lanes = 1;
    MathMode math = MathMode::precise;
    std::string kernels = "kernels/render.cl"; // the file with the entry points, below cl/
    // For benchmarks:
    bool count_tests = false; // kernels count what they test (Scene::tests); a render's film holds rays, shadow rays
                              // and rounds of a path
    std::string twice{};      // a stage that is done twice, to the same end: "traversal", "sampling" (random numbers)
    std::string note{};       // letters and digits that make the text another one, which no driver has in its cache
};

// The width of a kernel on that device: `wanted`, or the device's own where that is 0, which doubles halve (4 at
// least). Error where the device has no doubles and the math asks for them.
int lanes_for(const DeviceInfo &info, int wanted, MathMode math);

// The sources below cl/, embedded in the binary or read from --cl-dir.
struct Sources {
    std::map<std::string, std::string> files; // "core/math.cl" -> text
    static const Sources &embedded();
    static Sources from_folder(const std::string &folder);
    // Text of `file` for a kernel of so many lanes, with every #include "x" expanded once, in place, between #line
    // directives. Files in a folder many_lanes/ are left out of programs of one lane, those in one_lane/ of all others.
    // Error: file:line of an include that is not there, and what is.
    std::string expand(const std::string &file, int lanes) const;
};

// Defines (every feature, every axis, LANES, OPAL_DOUBLE, OPAL_FAST, OPAL_COUNT_TESTS, OPAL_REPEAT_*) followed by the
// expanded sources.
std::string program_text(const Features &features, const BuildOptions &options, const Sources &sources);

// Compiles with -cl-std=CL1.2, -cl-fast-relaxed-math for MathMode::fast, and $OPAL_KERNEL_FLAGS. What the driver
// remarks is told by --verbose. Error: device, driver, the whole build log.
cl::Program build_program(const Device &device, const std::string &text, const BuildOptions &options,
                          double *seconds = nullptr);

} // namespace opal
