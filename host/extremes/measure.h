// One sweep: a row's scenes rendered in single and in double precision with the same random numbers.
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "extremes/rows.h"
#include "film/film.h"

namespace opal::extremes {

struct Point {
    double value;          // of the row's parameter
    double single, oracle; // mean luminance of the two pictures
    double noise;          // relative standard error of `single`, as rendered
    double error;          // |single - oracle| / oracle: what rounding did to the energy
    double paired_noise;   // relative standard error of single - oracle: what a few paths sent elsewhere explain
    std::optional<double> single_truth,
        oracle_truth; // relative errors against the truth or, of an invariant row, the start's oracle
    std::optional<double> leaks,
        shadows; // shares of rays, single precision: through closed walls; into their own plane
    unsigned long long invalid_single, invalid_oracle;
    std::string fault; // why single precision is not correct here; empty: it is
};

struct Sweep {
    const Row *row;
    std::vector<Point> points;
    double from, to; // around the start, where single precision is correct; NaN: not even there
    bool kept;       // what is promised holds
};

// Renders the row on `device`, every `stride`th value and the last. Error: what the renderer throws.
Sweep sweep(const Row &row, const Device &device, const How &how, size_t stride);

// "correct from 1e-05 to 1e+06; at 1e-06: energy off by 0.0031, leaks 2e-05"
std::string breaking_point(const Sweep &sweep);

} // namespace opal::extremes
