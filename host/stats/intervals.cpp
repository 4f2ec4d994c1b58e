#include "stats/intervals.h"

#include "stats/hypothesis.h"
#include "stats/special.h"

#include <cmath>

namespace opal::stats {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Quantile of t with (1 - confidence) / 2 above it.
double t_factor(double confidence, double dof) { return -student_t_quantile((1 - confidence) / 2, dof); }

bool usable(Sample s) { return s.n > 1 && std::isfinite(s.mean) && std::isfinite(s.variance) && s.variance >= 0; }

double relative_variance_of_mean(Sample s) { return s.variance / s.n / (s.mean * s.mean); }

// estimate * exp(-+ half_width)
Interval log_interval(double estimate, double half_width) {
    return {estimate, estimate * std::exp(-half_width), estimate * std::exp(half_width)};
}

} // namespace

Interval mean_interval(Sample s, double confidence) {
    if (!usable(s))
        return {s.mean, -infinity, infinity};
    double half_width = t_factor(confidence, s.n - 1) * std::sqrt(s.variance / s.n);
    return {s.mean, s.mean - half_width, s.mean + half_width};
}

Interval positive_mean_interval(Sample s, double confidence) {
    if (!usable(s) || s.mean <= 0)
        return {s.mean, 0, infinity};
    return log_interval(s.mean, t_factor(confidence, s.n - 1) * std::sqrt(relative_variance_of_mean(s)));
}

Interval ratio_interval(Sample a, Sample b, double confidence) {
    double ratio = a.mean / b.mean;
    if (!usable(a) || !usable(b) || a.mean <= 0 || b.mean <= 0)
        return {ratio, -infinity, infinity};
    double va = relative_variance_of_mean(a), vb = relative_variance_of_mean(b);
    double dof = welch_dof(va, a.n - 1, vb, b.n - 1);
    return log_interval(ratio, t_factor(confidence, dof) * std::sqrt(va + vb));
}

Interval paired_ratio_interval(std::span<const double> a, std::span<const double> b, double confidence) {
    Moments ma, mb, difference;
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        ma.add(a[i]), mb.add(b[i]);
    double ratio = ma.mean() / mb.mean();
    if (a.size() != b.size() || a.size() < 2 || !(ma.mean() > 0 && mb.mean() > 0 && std::isfinite(ratio)))
        return {ratio, -infinity, infinity};
    for (size_t i = 0; i < a.size(); ++i)
        difference.add(a[i] / ma.mean() - b[i] / mb.mean());
    return log_interval(ratio, t_factor(confidence, difference.n() - 1) * std::sqrt(difference.variance_of_mean()));
}

LogLogFit fit_log_log(std::span<const double> x, std::span<const double> y, std::span<const double> weights,
                      double confidence) {
    LogLogFit fit;
    if (x.size() != y.size() || x.size() < 2 || (!weights.empty() && weights.size() != x.size()))
        return fit;
    auto weight = [&](size_t i) { return weights.empty() ? 1.0 : weights[i]; };
    double sw = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, residuals = 0;
    for (size_t i = 0; i < x.size(); ++i)
        sw += weight(i), sx += weight(i) * std::log(x[i]), sy += weight(i) * std::log(y[i]);
    double mx = sx / sw, my = sy / sw;
    for (size_t i = 0; i < x.size(); ++i) {
        double dx = std::log(x[i]) - mx, dy = std::log(y[i]) - my;
        sxx += weight(i) * dx * dx, sxy += weight(i) * dx * dy;
    }
    double slope = sxy / sxx;
    if (!std::isfinite(slope)) // one abscissa only, or a value that has no logarithm
        return fit;
    fit.slope.estimate = slope;
    fit.intercept = my - slope * mx;
    fit.dof = double(x.size()) - 2;
    if (fit.dof == 0)
        return fit;
    for (size_t i = 0; i < x.size(); ++i) {
        double r = std::log(y[i]) - fit.intercept - slope * std::log(x[i]);
        residuals += weight(i) * r * r;
    }
    fit.slope_error = std::sqrt(residuals / fit.dof / sxx);
    double half_width = t_factor(confidence, fit.dof) * fit.slope_error;
    fit.slope = {slope, slope - half_width, slope + half_width};
    return fit;
}

} // namespace opal::stats
