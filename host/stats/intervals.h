// Confidence intervals. Data that cannot tell (fewer than two observations, values that are not finite, a ratio of
// means that are not positive) give the whole line.
#pragma once

#include "stats/moments.h"

#include <limits>
#include <span>

namespace opal::stats {

struct Interval {
    double estimate = std::numeric_limits<double>::quiet_NaN();
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    bool contains(double x) const { return x >= low && x <= high; }
};

// mean -+ t(n - 1) s / sqrt n
Interval mean_interval(Sample sample, double confidence);

// For a positive, skewed quantity (an MSE): mean * exp(-+ t(n - 1) s / (mean sqrt n)), the delta method on log mean.
// Never reaches 0. The whole half-line from 0 where the mean is not positive.
Interval positive_mean_interval(Sample sample, double confidence);

// E[a] / E[b] of two independent positive samples, by the delta method on the logarithm: the relative variances of both
// means add, with Welch's degrees of freedom.
Interval ratio_interval(Sample a, Sample b, double confidence);

// The same for paired samples (same seeds, same run), whose covariance counts: by a_i / mean(a) - b_i / mean(b). a and
// b have one length.
Interval paired_ratio_interval(std::span<const double> a, std::span<const double> b, double confidence);

// Least squares of log y = intercept + slope log x, x and y positive. `weights`, 1 / variance of log y up to a factor,
// may be empty; the factor is estimated from the residuals, so that the slope's standard error has n - 2 degrees of
// freedom. Seber & Lee, "Linear Regression Analysis", 2nd ed., section 6.1.
struct LogLogFit {
    Interval slope;
    double slope_error = std::numeric_limits<double>::infinity(), intercept = std::numeric_limits<double>::quiet_NaN();
    double dof = 0;
};
LogLogFit fit_log_log(std::span<const double> x, std::span<const double> y, std::span<const double> weights,
                      double confidence);

} // namespace opal::stats
