// What a check found: figures against their limits.
#pragma once

#include <string>
#include <vector>

namespace opal {

// How the figures of several cases make one: the smallest p-value, the largest error, the sum of the counts.
enum class FigureKind { p_value, error, count };

// One comparison. A figure may be a NaN: then it has not passed.
struct Finding {
    std::string check; // "warps: samples against density, smallest p"
    double figure = 0, limit = 0;
    bool passed = false;
    std::string subject = ""; // the case that was compared: "beckmann 0.3"
    FigureKind kind = FigureKind::error;
};
using Findings = std::vector<Finding>;

// Level of each check that judges samples: one false alarm in ten thousand right devices, at about ten such checks.
inline constexpr double selftest_level = 1e-5;

inline Finding at_most(std::string check, double figure, double limit, std::string subject = "") {
    return {std::move(check), figure, limit, figure <= limit, std::move(subject), FigureKind::error};
}
// A count of what must not be.
inline Finding none_wrong(std::string check, double count, std::string subject = "") {
    return {std::move(check), count, 0, count == 0, std::move(subject), FigureKind::count};
}
inline Finding p_value(std::string check, double p, std::string subject = "") {
    return {std::move(check), p, selftest_level, p >= selftest_level, std::move(subject), FigureKind::p_value};
}

// The larger of two errors; NaN is larger than anything.
inline double worst_of(double a, double b) { return a != a || a > b ? a : b; }

void append(Findings &findings, Findings more);

// One finding for each check, in the order of their first cases: the smallest p-value of its cases, corrected for their
// number (Sidak), the largest error, the sum of the counts. Its subject is the worst case.
Findings summary_of(const Findings &cases);

} // namespace opal
