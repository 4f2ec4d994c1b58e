#include "scene/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opal {

namespace {

// sin(pi x) / (pi x), x not negative. Below the threshold it rounds to 1.
template <class Real> Real sinc(Real x) {
    const Real angle = Real(std::numbers::pi) * x;
    return x > Real(1e-9) ? std::sin(angle) / angle : Real(1);
}

// filter_1d of the device. Real: float, or double to tell rounding.
template <class Real> Real weight_of(const Filter &filter, Real distance) {
    const Real a = std::abs(distance), radius = Real(float(filter.radius));
    if (!(a <= radius))
        return 0;
    switch (filter.kind) {
    case FILTER_tent:
        return std::max(1 - a / radius, Real(0));
    case FILTER_gaussian: {
        const Real stddev = Real(float(filter.stddev)), falloff = Real(-0.5) / (stddev * stddev);
        return std::max(std::exp(falloff * a * a) - std::exp(falloff * radius * radius), Real(0));
    }
    case FILTER_lanczos:
        return sinc(a) * sinc(a / radius);
    case FILTER_mitchell: {
        const Real t = 2 * a / radius, t2 = t * t, b = Real(float(filter.b)), c = Real(float(filter.c));
        return (t < 1 ? ((12 - 9 * b - 6 * c) * t + (-18 + 12 * b + 6 * c)) * t2 + (6 - 2 * b)
                      : (((-b - 6 * c) * t + (6 * b + 30 * c)) * t + (-12 * b - 48 * c)) * t + (8 * b + 24 * c)) /
               6;
    }
    default:
        return 1;
    }
}

// All weights that a sample at `offset` from its pixel's centre has, together: in its pixel and in those around it.
// absolute: without their signs.
template <class Real> Real total_weight(const Filter &filter, Real offset, bool absolute = false) {
    constexpr double most = 64; // beyond, nothing new is seen
    const int reach = int(std::ceil(std::clamp(filter.radius, 0.5, most) - 0.5));
    Real total = 0;
    for (int pixel = -reach; pixel <= reach; pixel++) {
        const Real weight = weight_of(filter, offset + Real(pixel));
        total += absolute ? std::abs(weight) : weight;
    }
    return total;
}

// Whether a sample at `offset` counts. largest: the weight of one at the pixel's centre.
bool counts(const Filter &filter, float offset, double largest) {
    // The device multiplies a weight of each axis with the radiance. They share the exponents of single precision.
    constexpr double least_product = 0x1p-63;
    constexpr double most_rounding = 0.01; // relative
    // The weights without their signs over those with them: noise grows by it. It is 4.1 for Mitchell's B 0, C 1 at the
    // least radius, 1.5 at radius 2.
    constexpr double most_cancelling = 5;
    const double own = double(weight_of(filter, offset)), total = double(total_weight(filter, offset));
    const double exact_total = total_weight(filter, double(offset));
    return own > 0 && std::isfinite(own) && own * own >= least_product && own * own <= 1 / least_product &&
           std::abs(own - weight_of(filter, double(offset))) <= most_rounding * largest && total > 0 &&
           std::isfinite(total) && total_weight(filter, double(offset), true) <= most_cancelling * exact_total &&
           std::abs(total - exact_total) <= most_rounding * exact_total;
}

} // namespace

std::string filter_text(const Filter &filter) {
#define OPAL_NAME(name) #name,
    static const char *const names[] = {OPAL_FILTERS(OPAL_NAME)};
#undef OPAL_NAME
    const bool is_spline = filter.kind == FILTER_mitchell && filter.b == 0 && filter.c == 0.5;
    return fmt::format("{}, radius {:g} pixels", is_spline ? "catmullrom (mitchell of B 0, C 0.5)" : names[filter.kind],
                       filter.radius);
}

double filter_extent(const Filter &filter) {
    constexpr double deviations = 14.5; // exp(-14.5^2 / 2) rounds to 0 in single precision
    return filter.kind == FILTER_gaussian ? std::min(filter.radius, deviations * filter.stddev) : filter.radius;
}

std::string filter_problem(const Filter &filter) {
    constexpr int steps = 64; // from one border of the pixel to the other
    const double largest = weight_of(filter, 0.0);
    for (int i = 0; i <= steps; i++)
        if (!(filter.stddev > 0) || !counts(filter, float(i) / steps - 0.5f, largest)) {
            const std::string what = "samples in a pixel need weights above 0 that single precision can hold";
            if (filter.kind == FILTER_gaussian)
                return fmt::format("{}, stddev {:g}: {}; possible: a radius above 0.5, and a stddev from 0.08 to 10 "
                                   "times the radius",
                                   filter_text(filter), filter.stddev, what);
            if (filter.kind == FILTER_lanczos)
                return fmt::format("{}: {}; possible: a radius above 0.5", filter_text(filter), what);
            return fmt::format("{}, B {:g}, C {:g}: {}; possible: a radius above 1, and B and C from 0 to 1",
                               filter_text(filter), filter.b, filter.c, what);
        }
    return "";
}

} // namespace opal
