// Running sums, means and variances, without cancellation and independent of how the work is split.
#pragma once

#include <cmath>

namespace opal::stats {

// A sample: its size, its mean, and the unbiased variance of ONE observation (not of the mean).
struct Sample {
    double n = 0, mean = 0, variance = 0;
};

// Compensated sum (Neumaier, ZAMM 54, 1974): an error of a few ulp, whatever the number of terms.
class CompensatedSum {
public:
    void add(double x) {
        double t = sum_ + x;
        if (std::isfinite(t)) // else the correction would make an infinity a NaN
            error_ += std::abs(sum_) >= std::abs(x) ? (sum_ - t) + x : (x - t) + sum_;
        sum_ = t;
    }
    double value() const { return sum_ + error_; }
    double subtracted_from(double x) const { return (x - sum_) - error_; } // x - value(), unrounded in between

private:
    double sum_ = 0, error_ = 0;
};

// Mean and second central moment: Welford's update and the merge of Chan, Golub & LeVeque, "Updating formulae and a
// pairwise algorithm for computing sample variances", 1979, with both sums compensated. One NaN makes mean and variance
// NaN.
class Moments {
public:
    void add(double x) { merge(1, x, 0); }
    void merge(const Moments &other) { merge(other.n_, other.mean(), other.m2_.value()); }
    double n() const { return n_; }
    double mean() const { return mean_.value(); }
    double variance() const { return n_ > 1 ? m2_.value() / (n_ - 1) : NAN; } // of one observation, unbiased
    double variance_of_mean() const { return variance() / n_; }
    Sample sample() const { return {n_, mean(), variance()}; }

private:
    void merge(double n, double mean, double m2) {
        if (n == 0)
            return;
        double delta = mean_.subtracted_from(mean), total = n_ + n;
        mean_.add(delta * (n / total));
        m2_.add(m2);
        m2_.add(delta * delta * (n_ * (n / total)));
        n_ = total;
    }
    double n_ = 0;
    CompensatedSum mean_, m2_;
};

} // namespace opal::stats
