// The run of a stress test: a row's scenes are rendered in single and in double precision with the same random numbers.
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "extremes/rows.h"
#include "film/film.h"

#include <functional>

namespace opal::extremes {

// The measurements at one value of a row.
struct StressPoint {
    double value;          // of the row's parameter
    double single, oracle; // mean luminance in single and in double precision, or the figure of a numeric row
    double noise;          // relative standard error of `single`
    double error;          // |single - oracle| / oracle, the error of the energy by rounding
    double paired_noise;   // relative standard error of single - oracle; paths that rounding sends elsewhere cause it
    // Relative errors against the truth or, in an invariant row, against double precision at the start.
    std::optional<double> single_truth, oracle_truth;
    // Shares of rays, in single precision, that pass closed walls and that hit the plane which they start from.
    std::optional<double> leaks, shadows;
    unsigned long long invalid_single, invalid_oracle;
    std::string fault; // why single precision is wrong here; empty: it is correct
};

// The measurements of a row.
struct StressResult {
    const StressRow *row;
    std::vector<StressPoint> points;
    double from, to; // the working range: values around the start without a fault; NaN: the start has one
    bool kept;       // no value of the promised range has a fault
};

// Every `stride`th value of the row, the last one, the start and the ends of the promised range.
std::vector<double> values_of(const StressRow &row, size_t stride);

// Runs the row on `device` with values_of(row, stride); calls on_value after each. Throws the renderer's Error.
StressResult run_stress(const StressRow &row, const Device &device, const StressSettings &settings, size_t stride,
                        const std::function<void()> &on_value = {});

// The working range and the faults next to it: "correct from 1e-05 to 1e+06; at 1e-06 energy off by 0.0031".
std::string breaking_point(const StressResult &result);

} // namespace opal::extremes
