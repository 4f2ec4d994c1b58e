// The text of a program: self-contained, so that drivers cache it rightly.
#pragma once

#include "scene/strategy.h"

#include <map>
#include <string>

namespace opal {

struct Features;

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

// The sources below cl/, embedded in the binary or read from --cl-dir.
struct Sources {
    std::map<std::string, std::string> files; // "math.cl" -> text
    static const Sources &embedded();
    static Sources from_folder(const std::string &folder);
    // Text of `file` for a kernel of so many lanes, with every #include "x" expanded once, in place, between #line
    // directives. Files below one_lane/ are left out where there are more lanes. Error: file:line of an include that is
    // not there, and what is.
    std::string expand(const std::string &file, int lanes) const;
};

// Defines (every feature, every axis, LANES, OPAL_DOUBLE, OPAL_FAST, OPAL_COUNT_TESTS, OPAL_TWICE_*) followed by the
// expanded sources.
std::string program_text(const Features &features, const BuildOptions &options, const Sources &sources);

} // namespace opal
