// The bootstrap: the spread of a statistic, from the same statistic of observations drawn again with replacement.
#pragma once

#include "stats/intervals.h"

#include <functional>
#include <vector>

namespace opal::stats {

// Draws of n observations out of n with replacement, as indices; the same for the same arguments. Statistics that are
// computed from the same draws are paired: an interval of their ratio knows what they have in common.
std::vector<std::vector<size_t>> bootstrap_draws(size_t n, size_t count, unsigned seed);

// The interval of a positive statistic whose logarithm is about normal: estimate * exp(-+ t(n - 1) e), where e is the
// standard deviation of the logarithms over all draws, times sqrt(n / (n - 1)), which takes the bootstrap's bias from
// it (Efron and Tibshirani, "An Introduction to the Bootstrap", 1993, sections 5.3 and 6.5; Hesterberg, "What Teachers
// Should Know About the Bootstrap", 2015, section 3.2). The whole half-line from 0 where a value is not positive, and
// of fewer than two observations.
Interval bootstrap_interval(const std::vector<std::vector<size_t>> &draws, double confidence,
                            const std::function<double(const std::vector<size_t> &)> &statistic);

} // namespace opal::stats
