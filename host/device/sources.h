// The text of a program, without includes: drivers' caches see the text alone.
#pragma once

#include "scene/strategy.h"

#include <map>
#include <string>

namespace opal {

struct Features;

struct BuildOptions {
    int lanes = 1;
    MathMode math = MathMode::precise;
    std::string kernels{}; // the file with the entry points, below cl/; empty: the loop of the scene's integrator
    // For benchmarks:
    bool count_tests = false;   // kernels count (cl/shared/counters.h); a film then holds rays, shadow rays and rounds
    std::string repeat_stage{}; // a stage that is done twice: "traversal", "sampling" (random numbers)
    std::string cache_salt{};   // letters and digits that make the text another one, which no driver has in its cache
};

// The sources below cl/, embedded in the binary or read from --cl-dir.
struct Sources {
    std::map<std::string, std::string> files; // "core/math.cl" -> text
    static const Sources &embedded();
    static Sources from_folder(const std::string &folder);
    // Text of `file` for a kernel of so many lanes, with every #include "x" expanded once, in place, between #line
    // directives. #include "folder/*.cl" stands for all .cl files of that folder but the file it stands in. Files in a
    // folder many_lanes/ are left out of programs of one lane, those in one_lane/ of all others.
    // Error: file:line of an include that is not there, and what is.
    std::string expand(const std::string &file, int lanes) const;
};

// Defines (every feature, every axis, LANES, OPAL_DOUBLE, OPAL_FAST, OPAL_COUNT_TESTS, OPAL_REPEAT_*) followed by the
// expanded sources.
std::string program_text(const Features &features, const BuildOptions &options, const Sources &sources);

} // namespace opal
