// The tests, tested: p-values of right data are uniform (fixed seeds), wrong data and NaN are rejected.
#include "stats/hypothesis.h"
#include "stats/special.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using namespace opal::stats;

namespace {

using Counts = std::vector<double>;

// Counts of n draws with x uniform on [0, 1) mapped by `warp`, in 20 equal cells.
template <class Warp> Counts histogram(int n, unsigned seed, Warp warp) {
    std::mt19937_64 rng(seed);
    std::uniform_real_distribution<double> uniform;
    Counts counts(20);
    for (int i = 0; i < n; ++i)
        ++counts[size_t(20 * warp(uniform(rng)))];
    return counts;
}

// n * integral over each cell of a + 2 (1 - a) x, a density on [0, 1].
Counts linear(double n, double a) {
    Counts expected;
    for (double lo = 0, width = 1.0 / 20; expected.size() < 20; lo += width)
        expected.push_back(n * width * (a + (1 - a) * (2 * lo + width)));
    return expected;
}

double root(double x) { return std::sqrt(x); } // has the density 2x

Sample normal_sample(std::mt19937_64 &rng, int n, double mean, double sigma) {
    std::normal_distribution<double> normal(mean, sigma);
    Moments moments;
    for (int i = 0; i < n; ++i)
        moments.add(normal(rng));
    return moments.sample();
}

constexpr double level = 1e-3; // of each check on a fixed seed

} // namespace

TEST_CASE("chi-square: right densities give uniform p-values", "[stats_hypothesis]") {
    std::vector<double> p;
    for (unsigned seed = 0; seed < 300; ++seed)
        p.push_back(chi_square_test(histogram(2000, seed, root), linear(2000, 0)).p_value);
    CHECK_FALSE(ks_uniform_test(p).rejected(level));
}

TEST_CASE("chi-square: wrong densities are rejected", "[stats_hypothesis]") {
    Counts drawn = histogram(200000, 1, root);
    CHECK_FALSE(chi_square_test(drawn, linear(2e5, 0)).rejected(level));
    CHECK(chi_square_test(drawn, linear(2e5, 0.02)).rejected(level)); // 2 % of uniform mixed in
    CHECK(chi_square_test(drawn, linear(2e5, 1)).rejected(level));    // the cosine dropped
    CHECK(chi_square_test(drawn, linear(1.02 * 2e5, 0)).reason.find("sums to 1.02") != std::string::npos);
    Counts doubled = linear(2e5, 0); // 2 % moved from one cell to its neighbour
    double moved = 0.02 * doubled[10];
    doubled[10] -= moved, doubled[11] += moved;
    CHECK(chi_square_test(histogram(2000000, 2, root),
                          [&] {
                              for (double &e : doubled)
                                  e *= 10;
                              return doubled;
                          }())
              .rejected(level));
}

TEST_CASE("chi-square: cells", "[stats_hypothesis]") {
    Counts observed = {10, 12, 1, 2, 3, 0}, expected = {11, 11, 2, 2, 2, 0};
    TestResult r = chi_square_test(observed, expected); // 0+2+2+2 make a pool
    CHECK(r.dof == 2);
    CHECK(r.statistic == Approx(2.0 / 11));
    CHECK(r.p_value == Approx(std::exp(-1.0 / 11))); // Q(1, x/2) = exp(-x/2)
    observed[5] = 1, observed[0] = 9;
    CHECK(chi_square_test(observed, expected).reason.find("density is zero") != std::string::npos);
    CHECK(chi_square_test(observed, expected).p_value == 0);
    expected[5] = NAN;
    CHECK(chi_square_test(observed, expected).p_value == 0);
    expected[5] = -1, expected[0] = 12;
    CHECK(chi_square_test(observed, expected).p_value == 0);
    CHECK(chi_square_test(Counts{NAN, 10}, Counts{5, 5}).p_value == 0);
    CHECK(chi_square_test(Counts{100, 0}, Counts{100, 0}).p_value == 0); // cannot fail, so it does not pass
    CHECK(chi_square_test(Counts{3, 3}, Counts{3, 3}).p_value == 0);
    CHECK(chi_square_test(Counts{3, 3}, Counts{3, 3, 0}).p_value == 0);
    CHECK(chi_square_test(Counts{}, Counts{}).p_value == 0);
}

TEST_CASE("tests of means: uniform p-values where the means agree", "[stats_hypothesis]") {
    std::mt19937_64 rng(3);
    std::vector<double> one, two, large;
    for (int i = 0; i < 500; ++i) {
        one.push_back(t_test(normal_sample(rng, 5, 2, 0.5), 2).p_value);
        two.push_back(welch_test(normal_sample(rng, 8, -1, 0.1), normal_sample(rng, 30, -1, 3)).p_value);
        large.push_back(z_test(normal_sample(rng, 1000, 2, 0.5), 2).p_value);
    }
    CHECK_FALSE(ks_uniform_test(one).rejected(level));
    CHECK_FALSE(ks_uniform_test(two).rejected(level));
    CHECK_FALSE(ks_uniform_test(large).rejected(level));
    for (double &p : one) // negative control of the control: half the p-value
        p /= 2;
    CHECK(ks_uniform_test(one).rejected(level));
}

TEST_CASE("tests of means: known values", "[stats_hypothesis]") {
    // Student, Biometrika 6, 1908: hours of sleep gained, differences of 10 patients: t = 4.0621, p = 0.00283.
    Moments sleep;
    for (double d : {1.2, 2.4, 1.3, 1.3, 0.0, 1.0, 1.8, 0.8, 4.6, 1.4})
        sleep.add(d);
    CHECK(t_test(sleep.sample(), 0).statistic == Approx(4.0621).epsilon(1e-5));
    CHECK(t_test(sleep.sample(), 0).p_value == Approx(0.002833).epsilon(1e-3));
    // Var (4 + 1) / 10 each: dof = 0.5^2 / (0.4^2/9 + 0.1^2/9) = 13.2353
    TestResult w = welch_test({10, 3, 4}, {10, 2, 1});
    CHECK(w.dof == Approx(13.2353).epsilon(1e-5));
    CHECK(w.statistic == Approx(std::sqrt(2)));
}

TEST_CASE("tests of means: wrong means and what is no number are rejected", "[stats_hypothesis]") {
    std::mt19937_64 rng(4);
    Sample s = normal_sample(rng, 100000, 1, 0.5), off = normal_sample(rng, 100000, 1.02, 0.5);
    CHECK(t_test(s, 1.02).rejected(level));
    CHECK(z_test(s, 1.02).rejected(level));
    CHECK(welch_test(s, off).rejected(level));
    CHECK_FALSE(welch_test(s, {1e5, 1, 0.25}).rejected(level));
    for (Sample bad : {Sample{100, NAN, 1}, Sample{100, 1, NAN}, Sample{100, INFINITY, 1}, Sample{100, 1, -1},
                       Sample{1, 1, 0}, Sample{0, 1, 1}, Sample{NAN, 1, 1}}) {
        CAPTURE(bad.n, bad.mean, bad.variance);
        CHECK(t_test(bad, 1).p_value == 0);
        CHECK(z_test(bad, 1).p_value == 0);
        CHECK(welch_test(bad, {100, 1, 1}).p_value == 0);
        CHECK(welch_test({100, 1, 1}, bad).p_value == 0);
    }
    CHECK(t_test({100, 1, 1}, NAN).p_value == 0);
    CHECK(two_sided_p(NAN, 5) == 0);
}

TEST_CASE("tests of means: the floor of the variance is relative", "[stats_hypothesis]") {
    for (double scale : {1e-12, 1.0, 1e12}) { // the verdict doesn't depend on the unit
        CHECK_FALSE(t_test({100000, scale * (1 + 1e-6), 0}, scale).rejected(level));
        CHECK(t_test({100000, scale * 1.001, 0}, scale).rejected(level));
        CHECK(welch_test({1000, scale, 0}, {1000, scale * 1.001, 0}).rejected(level));
    }
    CHECK(t_test({100, 0, 0}, 0).p_value == 1);
    CHECK(t_test({100, 1e-30, 0}, 0).rejected(level)); // light where there must be none
}

TEST_CASE("Kolmogorov-Smirnov, binomial, Sidak, power", "[stats_hypothesis]") {
    CHECK(ks_uniform_test(Counts{0.1, 0.5, NAN, 0.7}).p_value == 0);
    CHECK(ks_uniform_test(Counts{0.1, 0.5, 1.1, 0.7}).p_value == 0);
    CHECK(ks_uniform_test(Counts{0.1}).p_value == 0);
    Counts even;
    for (int i = 0; i < 10; ++i)
        even.push_back(0.05 + 0.1 * i);
    CHECK(ks_uniform_test(even).statistic == Approx(0.05));
    // P(X <= 2) + P(X >= 8), n = 10, p = 1/2: 2 * 56 / 1024
    CHECK(binomial_test(2, 10, 0.5).p_value == Approx(112.0 / 1024));
    CHECK(binomial_test(5, 10, 0.5).p_value == 1);
    CHECK(binomial_test(0, 100, 0.05).p_value == Approx(2 * std::pow(0.95, 100)));
    CHECK(binomial_test(93, 100, 0.95).p_value > 0.3);
    CHECK(binomial_test(80, 100, 0.95).rejected(level));
    CHECK(binomial_test(NAN, 100, 0.95).p_value == 0);
    CHECK(sidak_level(0.05, 10) == Approx(0.005116197).epsilon(1e-6));
    CHECK(sidak_p(sidak_level(0.01, 1e6), 1e6) == Approx(0.01));
    CHECK(sidak_p(0, 10) == 0);
    CHECK(sidak_p(1, 10) == 1);
    CHECK(sidak_p(NAN, 10) == 0);
    // z(0.975) + z(0.8) = 1.95996 + 0.84162
    CHECK(detectable_difference(2, 0.05, 0.8) == Approx(2 * 2.80158).epsilon(1e-5));
    std::mt19937_64 rng(5);
    int found = 0;
    double error = 1 / std::sqrt(200.0);
    for (int i = 0; i < 1000; ++i)
        found += z_test(normal_sample(rng, 200, detectable_difference(error, 0.01, 0.8), 1), 0).rejected(0.01);
    CHECK_FALSE(binomial_test(found, 1000, 0.8).rejected(level));
}
