// Hypothesis tests. Each returns a p-value. Data that cannot be judged (NaN, infinite, too few observations) give p =
// 0, so that a defect never passes by mistake.
#pragma once

#include "stats/moments.h"

#include <span>
#include <string>

namespace opal::stats {

struct TestResult {
    double statistic = 0, dof = 0;
    double p_value = 0;
    std::string reason; // of a rejection without a statistic; else empty
    bool rejected(double significance) const { return !(p_value >= significance); }
};

struct ChiSquareOptions {
    double min_expected = 5;      // cells that expect fewer are pooled, in ascending order, until a pool reaches it
    double mass_tolerance = 1e-3; // allowed relative difference between the sums of expected and observed
};

// Pearson's test that the counts `observed` were drawn with the expectations `expected` (the same number of cells;
// everything that can happen has a cell, also "outside the domain" with expectation 0). statistic = sum (o - e)^2 / e
// over the pools, dof = pools - 1. Rejected at once: a hit where 0 is expected, an expectation that is negative or not
// finite, sums that differ (a pdf that does not integrate to 1), and fewer than two pools, for which no sample could
// fail.
TestResult chi_square_test(std::span<const double> observed, std::span<const double> expected,
                           const ChiSquareOptions &options = {});

// Least standard error of a mean, as a fraction of the larger mean: the rounding of sums in single precision, which is
// left where a sample has no variance.
inline constexpr double default_relative_floor = 1e-5;

// Two-sided p-value of a standardised difference; dof = infinity is the z-test. NaN gives 0.
double two_sided_p(double statistic, double dof);

// (difference / error) with the error floored at relative_floor * scale, judged with dof; scale is the larger |mean|.
TestResult difference_test(double difference, double error, double dof, double scale,
                           double relative_floor = default_relative_floor);

// Tests that the sample has the mean `reference`, by the normal distribution or by Student's t with n - 1.
TestResult z_test(Sample sample, double reference, double relative_floor = default_relative_floor);
TestResult t_test(Sample sample, double reference, double relative_floor = default_relative_floor);

// Tests that two independent samples have one mean: t with Welch and Satterthwaite's degrees of freedom (Welch,
// Biometrika 34, 1947).
TestResult welch_test(Sample a, Sample b, double relative_floor = default_relative_floor);
// (va + vb)^2 / (va^2/da + vb^2/db) for the sum of two variance estimates; infinity where both are 0.
double welch_dof(double va, double da, double vb, double db);

// Tests that the values (p-values of a suite) are uniform on [0, 1]: Kolmogorov-Smirnov with the finite-n correction of
// Stephens, JRSS B 32, 1970: lambda = (sqrt n + 0.12 + 0.11 / sqrt n) D. Needs 4 values; one outside [0, 1] is
// rejected.
TestResult ks_uniform_test(std::span<const double> values);

// Tests that `successes` of `trials` happened with this probability. Exact and two-sided: twice the smaller tail.
TestResult binomial_test(double successes, double trials, double probability);

// Sidak's correction (JASA 62, 1967) for `count` tests: the level of each that gives all together the level
// `significance`, and the p-value of all together from the smallest p. Exact for independent tests, conservative for
// positively dependent ones.
double sidak_level(double significance, double count);
double sidak_p(double smallest_p, double count);

// The smallest difference that a two-sided test at this level finds with probability `power`, where the estimate has
// this standard error: (z(1 - significance/2) + z(power)) * error.
double detectable_difference(double error, double significance, double power);

} // namespace opal::stats
