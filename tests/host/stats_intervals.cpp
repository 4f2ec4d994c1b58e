// Intervals hold the truth as often as they say (fixed seeds, judged by the binomial test), and moments don't cancel.
#include "stats/bootstrap.h"
#include "stats/hypothesis.h"
#include "stats/intervals.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using namespace opal::stats;

namespace {

constexpr int trials = 4000;
constexpr double level = 1e-3;

// How often `interval(rng)` holds `truth`.
template <class Make> int coverage(double truth, unsigned seed, Make interval) {
    std::mt19937_64 rng(seed);
    int held = 0;
    for (int i = 0; i < trials; ++i)
        held += interval(rng).contains(truth);
    return held;
}

// An MSE of a replicate is a mean of many squares: gamma distributed, here with mean 2 and 10 % (shape 100) by default.
std::vector<double> errors(std::mt19937_64 &rng, int n, double mean = 2, double shape = 100) {
    std::gamma_distribution<double> gamma(shape, mean / shape);
    std::vector<double> values(n);
    for (double &v : values)
        v = gamma(rng);
    return values;
}

Sample sample(const std::vector<double> &values) {
    Moments moments;
    for (double v : values)
        moments.add(v);
    return moments.sample();
}

bool as_stated(int held, double confidence) { return !binomial_test(held, trials, confidence).rejected(level); }

} // namespace

TEST_CASE("interval of a mean covers as stated", "[stats_intervals]") {
    auto normal = [](std::mt19937_64 &rng, double inflate) {
        std::normal_distribution<double> d(-1, 3);
        Moments m;
        for (int i = 0; i < 6; ++i)
            m.add(d(rng));
        Sample s = m.sample();
        s.variance *= inflate;
        return mean_interval(s, 0.95);
    };
    CHECK(as_stated(coverage(-1, 1, [&](auto &rng) { return normal(rng, 1); }), 0.95));
    CHECK_FALSE(as_stated(coverage(-1, 1, [&](auto &rng) { return normal(rng, 2); }), 0.95)); // the variance doubled
    CHECK_FALSE(as_stated(coverage(-1, 1, [&](auto &rng) { return normal(rng, 0.5); }), 0.95));
    auto positive = [](auto &rng) { return positive_mean_interval(sample(errors(rng, 5)), 0.95); };
    CHECK(as_stated(coverage(2, 2, positive), 0.95));
    CHECK_FALSE(as_stated(coverage(2 * 1.04, 2, positive), 0.95)); // a mean off by 4 %
}

TEST_CASE("interval of a ratio covers as stated", "[stats_intervals]") {
    auto unpaired = [](auto &rng) {
        auto a = errors(rng, 8, 3, 50), b = errors(rng, 16, 2, 200);
        return ratio_interval(sample(a), sample(b), 0.95);
    };
    CHECK(as_stated(coverage(1.5, 3, unpaired), 0.95));
    CHECK_FALSE(as_stated(coverage(1.5 * 1.05, 3, unpaired), 0.95));
    // A noise common to both (the machine's load): the paired interval knows, the unpaired one is too wide.
    auto pairs = [](auto &rng, bool paired) {
        auto a = errors(rng, 8, 3, 400), b = errors(rng, 8, 2, 400), load = errors(rng, 8, 1, 25);
        for (size_t i = 0; i < a.size(); ++i)
            a[i] *= load[i], b[i] *= load[i];
        return paired ? paired_ratio_interval(a, b, 0.9) : ratio_interval(sample(a), sample(b), 0.9);
    };
    CHECK(as_stated(coverage(1.5, 4, [&](auto &rng) { return pairs(rng, true); }), 0.9));
    CHECK_FALSE(as_stated(coverage(1.5, 4, [&](auto &rng) { return pairs(rng, false); }), 0.9));
}

TEST_CASE("slope of a log-log fit covers as stated", "[stats_intervals]") {
    std::vector<double> spp = {1, 4, 16, 64, 256};
    auto fit = [&](auto &rng, bool weighted) {
        std::vector<double> mse, weights;
        for (double x : spp) { // the noise differs from point to point where weights are used
            double shape = weighted ? 20 * std::sqrt(x) : 50;
            mse.push_back(errors(rng, 1, 7 / x, shape)[0]);
            weights.push_back(shape);
        }
        return fit_log_log(spp, mse, weighted ? weights : std::vector<double>{}, 0.95).slope;
    };
    for (bool weighted : {false, true}) {
        CHECK(as_stated(coverage(-1, 5, [&](auto &rng) { return fit(rng, weighted); }), 0.95));
        CHECK_FALSE(as_stated(coverage(-1.1, 5, [&](auto &rng) { return fit(rng, weighted); }), 0.95));
    }
    std::vector<double> exact = {3, 0.75};
    LogLogFit line = fit_log_log(std::vector<double>{1, 4}, exact, {}, 0.95);
    CHECK(line.slope.estimate == Approx(-1));
    CHECK(std::exp(line.intercept) == Approx(3));
    CHECK(std::isinf(line.slope.high)); // two points say nothing of their error
}

TEST_CASE("what cannot be known is the whole line", "[stats_intervals]") {
    double inf = INFINITY;
    for (Sample bad : {Sample{1, 2, 0}, Sample{5, NAN, 1}, Sample{5, 1, NAN}, Sample{5, 1, -1}}) {
        CHECK(mean_interval(bad, 0.95).high == inf);
        CHECK(positive_mean_interval(bad, 0.95).high == inf);
        CHECK(ratio_interval(bad, {5, 1, 1}, 0.95).low == -inf);
        CHECK(ratio_interval({5, 1, 1}, bad, 0.95).high == inf);
    }
    CHECK(paired_ratio_interval(std::vector<double>{1, NAN}, std::vector<double>{1, 2}, 0.95).high == inf);
    CHECK(paired_ratio_interval(std::vector<double>{1, 2, 3}, std::vector<double>{1, 2}, 0.95).high == inf);
    CHECK(
        std::isnan(fit_log_log(std::vector<double>{1, 2, 3}, std::vector<double>{1, NAN, 3}, {}, 0.95).slope.estimate));
    CHECK(std::isinf(fit_log_log(std::vector<double>{2, 2, 2}, std::vector<double>{1, 2, 3}, {}, 0.95).slope.high));
    CHECK(std::isinf(fit_log_log(std::vector<double>{1, 2, 3}, std::vector<double>{1, 0, 3}, {}, 0.95).slope.high));
}

TEST_CASE("moments don't cancel and merge in any split", "[stats_intervals]") {
    Moments whole, left, right, empty;
    for (int i = 0; i < 1000; ++i) { // variance of i % 2 about a mean of 1e9: n/4 / (n-1)
        whole.add(1e9 + i % 2);
        (i < 300 ? left : right).add(1e9 + i % 2);
    }
    left.merge(right);
    left.merge(empty);
    empty.merge(left);
    for (const Moments &m : {whole, left, empty}) {
        CHECK(m.n() == 1000);
        CHECK(m.mean() == Approx(1e9 + 0.5).epsilon(1e-15));
        CHECK(m.variance() == Approx(250.0 / 999).epsilon(1e-9));
        CHECK(m.variance_of_mean() == Approx(0.25 / 999).epsilon(1e-9));
    }
    CHECK(std::isnan(Moments().variance()));
    left.add(NAN);
    CHECK(std::isnan(left.mean()));
    CHECK(std::isnan(left.variance()));
    CompensatedSum sum;
    for (double x : {1.0, 1e100, 1.0, -1e100}) // Neumaier's example: 2, where plain summation says 0
        sum.add(x);
    CHECK(sum.value() == 2);
    sum.add(INFINITY);
    CHECK(sum.value() == INFINITY);
}

TEST_CASE("bootstrap intervals of means, of ratios that share noise and of ratios that do not cover as stated",
          "[stats_intervals]") {
    for (int n : {4, 6, 12}) {
        INFO(n);
        const auto draws = bootstrap_draws(size_t(n), 200, 1);
        const auto mean_of = [](const std::vector<double> &values, const std::vector<size_t> &draw) {
            double sum = 0;
            for (size_t i : draw)
                sum += values[i];
            return sum / double(draw.size());
        };
        const int mean = coverage(2, 3, [&](auto &rng) {
            const auto values = errors(rng, n);
            return bootstrap_interval(draws, 0.95, [&](const auto &draw) { return mean_of(values, draw); });
        });
        const int shared = coverage(4, 4, [&](auto &rng) {
            auto a = errors(rng, n, 4), b = errors(rng, n, 1);
            for (double factor; int i : {0, 1, 2, 3}) // a disturbance of whole rounds
                factor = 1 + 0.5 * double(rng() % 2), a[size_t(i)] *= factor, b[size_t(i)] *= factor;
            return bootstrap_interval(draws, 0.95,
                                      [&](const auto &draw) { return mean_of(a, draw) / mean_of(b, draw); });
        });
        // The draws are 200 of many, and logarithms only about normal: 93 to 97 %.
        for (int held : {mean, shared}) {
            CHECK(held > 0.93 * trials);
            CHECK(held < 0.97 * trials);
        }
    }
    const auto draws = bootstrap_draws(5, 200, 1);
    const auto constant = bootstrap_interval(draws, 0.95, [](const auto &) { return 3.0; });
    CHECK(constant.low == 3);
    CHECK(constant.high == 3);
    const auto negative = bootstrap_interval(draws, 0.95, [](const auto &draw) { return double(draw[0]) - 1; });
    CHECK_FALSE(std::isfinite(negative.high));
    const auto one = bootstrap_interval(bootstrap_draws(1, 200, 1), 0.95, [](const auto &) { return 3.0; });
    CHECK(one.estimate == 3);
    CHECK_FALSE(std::isfinite(one.high));
}
