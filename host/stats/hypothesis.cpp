#include "stats/hypothesis.h"

#include "stats/special.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace opal::stats {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TestResult reject(std::string reason) { return {NAN, 0, 0, std::move(reason)}; }

struct Pool {
    double observed = 0, expected = 0;
};

// Pools cells, in ascending order of expectation, until each pool expects min_expected. The rest joins the last pool.
std::vector<Pool> pool_cells(std::span<const double> observed, std::span<const double> expected, double min_expected) {
    std::vector<size_t> order(expected.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
    std::vector<Pool> pools;
    for (size_t cell : order) {
        if (pools.empty() || pools.back().expected >= min_expected)
            pools.push_back({});
        pools.back().observed += observed[cell];
        pools.back().expected += expected[cell];
    }
    if (pools.size() > 1 && pools.back().expected < min_expected) { // only where min_expected exceeds every cell
        Pool rest = pools.back();
        pools.pop_back();
        pools.back().observed += rest.observed;
        pools.back().expected += rest.expected;
    }
    return pools;
}

} // namespace

TestResult chi_square_test(std::span<const double> observed, std::span<const double> expected,
                           const ChiSquareOptions &options) {
    if (observed.size() != expected.size() || observed.empty())
        return reject("there are " + std::to_string(observed.size()) + " observed cells and " +
                      std::to_string(expected.size()) + " expected");
    CompensatedSum total_observed, total_expected;
    for (size_t i = 0; i < observed.size(); ++i) {
        std::string where = " in cell " + std::to_string(i);
        if (!(observed[i] >= 0 && expected[i] >= 0 && observed[i] < infinity && expected[i] < infinity))
            return reject("a count or an expectation is negative or not finite" + where);
        if (expected[i] == 0 && observed[i] > 0)
            return reject(std::to_string(size_t(observed[i])) + " hits where the density is zero," + where);
        total_observed.add(observed[i]);
        total_expected.add(expected[i]);
    }
    double n = total_observed.value();
    if (!(std::abs(total_expected.value() - n) <= options.mass_tolerance * n) || n == 0)
        return reject("the density sums to " + std::to_string(total_expected.value() / n) + " instead of 1");
    std::vector<Pool> pools = pool_cells(observed, expected, options.min_expected);
    if (pools.size() < 2 || pools.back().expected < options.min_expected)
        return reject("fewer than two cells after pooling: too few samples or too coarse a grid");
    TestResult result;
    for (const Pool &pool : pools)
        result.statistic += (pool.observed - pool.expected) * (pool.observed - pool.expected) / pool.expected;
    result.dof = double(pools.size() - 1);
    result.p_value = chi_square_sf(result.statistic, result.dof);
    return result;
}

double two_sided_p(double statistic, double dof) {
    double p = 2 * student_t_sf(std::abs(statistic), dof);
    return std::isnan(p) ? 0 : std::min(p, 1.0);
}

TestResult difference_test(double difference, double error, double dof, double scale, double relative_floor) {
    if (!(std::isfinite(difference) && std::isfinite(error) && error >= 0 && std::isfinite(scale)))
        return reject("a mean or a variance is not a finite number");
    if (!(dof > 0))
        return reject("too few observations for a variance");
    double floored = std::max(error, relative_floor * scale);
    double statistic = difference == 0 ? 0 : difference / floored; // 0/0: two exact zeros agree
    return {statistic, dof, two_sided_p(statistic, dof), {}};
}

TestResult z_test(Sample s, double reference, double relative_floor) {
    return difference_test(s.mean - reference, std::sqrt(s.variance / s.n), s.n > 1 ? infinity : 0,
                           std::max(std::abs(s.mean), std::abs(reference)), relative_floor);
}

TestResult t_test(Sample s, double reference, double relative_floor) {
    return difference_test(s.mean - reference, std::sqrt(s.variance / s.n), s.n - 1,
                           std::max(std::abs(s.mean), std::abs(reference)), relative_floor);
}

double welch_dof(double va, double da, double vb, double db) {
    double sum = va + vb;
    return sum == 0 ? infinity : 1 / (va / sum * (va / sum) / da + vb / sum * (vb / sum) / db);
}

TestResult welch_test(Sample a, Sample b, double relative_floor) {
    if (!(a.n > 1 && b.n > 1))
        return reject("too few observations for a variance");
    double va = a.variance / a.n, vb = b.variance / b.n;
    return difference_test(a.mean - b.mean, std::hypot(std::sqrt(va), std::sqrt(vb)),
                           welch_dof(va, a.n - 1, vb, b.n - 1), std::max(std::abs(a.mean), std::abs(b.mean)),
                           relative_floor);
}

TestResult ks_uniform_test(std::span<const double> values) {
    if (values.size() < 4)
        return reject("fewer than 4 values");
    std::vector<double> sorted(values.begin(), values.end());
    for (double v : sorted)
        if (!(v >= 0 && v <= 1))
            return reject("a value is not in [0, 1]");
    std::sort(sorted.begin(), sorted.end());
    double n = double(sorted.size()), distance = 0;
    for (size_t i = 0; i < sorted.size(); ++i)
        distance = std::max({distance, (double(i) + 1) / n - sorted[i], sorted[i] - double(i) / n});
    return {distance, n, kolmogorov_sf((std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance), {}};
}

TestResult binomial_test(double successes, double trials, double probability) {
    double k = successes, n = trials, p = probability;
    if (!(k >= 0 && k <= n && n > 0 && p >= 0 && p <= 1))
        return reject("no such counts or probability");
    double at_least = k == 0 ? 1 : beta_i(k, n - k + 1, p, 1 - p); // DLMF 8.17.5
    double at_most = k == n ? 1 : beta_i(n - k, k + 1, 1 - p, p);
    return {k / n, n, std::min(1.0, 2 * std::min(at_least, at_most)), {}};
}

double sidak_level(double significance, double count) { return -std::expm1(std::log1p(-significance) / count); }

double sidak_p(double smallest_p, double count) {
    return std::isnan(smallest_p) ? 0 : smallest_p >= 1 ? 1 : -std::expm1(count * std::log1p(-smallest_p));
}

double detectable_difference(double error, double significance, double power) {
    return (normal_quantile(power) - normal_quantile(significance / 2)) * error;
}

} // namespace opal::stats
