#include "flatten/plastic_boundary.h"

#include "scene/fresnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace opal {

namespace {

double square(double x) { return x * x; }

// Gauss's rule for an integral over [0, 1].
struct Rule {
    std::vector<double> points, weights;
};
// The roots of Legendre's polynomial by Newton's method, from an approximation that is near enough to each (Abramowitz
// and Stegun, 22.16.6 and 25.4.29).
Rule gauss_legendre(int count) {
    Rule rule;
    for (int i = 0; i < count; i++) {
        double x = -std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 0;
        for (int step = 0; step < 6; step++) {
            double before = 1, value = x;
            for (int n = 2; n <= count; n++)
                before = std::exchange(value, ((2 * n - 1) * x * value - (n - 1) * before) / n);
            slope = count * (x * value - before) / (x * x - 1);
            x -= value / slope;
        }
        rule.points.push_back((1 + x) / 2);
        rule.weights.push_back(1 / ((1 - x * x) * square(slope)));
    }
    return rule;
}

// Facets of roughness 1, as a direction sees them: their slopes along it and across it, in units of alpha.
struct Slope {
    double along, across;
};

// Slope x of Beckmann's facets along a direction of that sine and cosine: the density of visible ones is
// (cosine - sine x) exp(-x^2), up to x = cosine / sine. The share u of them is flatter than the result.
double beckmann_slope(double u, double sine, double cosine) {
    constexpr double steepest = 6; // exp(-36) of the facets are steeper
    const auto area = [&](double x) {
        return cosine * std::sqrt(std::numbers::pi) * std::erfc(-x) + sine * std::exp(-x * x);
    };
    double low = -steepest, high = cosine < steepest * sine ? cosine / sine : steepest;
    const double wanted = u * area(high);
    for (int step = 0; step < 45; step++) {
        const double middle = (low + high) / 2;
        (area(middle) < wanted ? low : high) = middle;
    }
    return (low + high) / 2;
}

// A point of the unit disk, by rings of squares (Shirley and Chiu 1997). u and v in (0, 1), neither 0.5
struct Point {
    double x, y;
};
Point disk_point(double u, double v) {
    const double a = 2 * u - 1, b = 2 * v - 1, eighth = std::numbers::pi / 4;
    if (std::abs(a) < std::abs(b))
        return {b * std::sin(eighth * a / b), b * std::cos(eighth * a / b)};
    return {a * std::cos(eighth * b / a), a * std::sin(eighth * b / a)};
}

// The slope of GGX facets that the half disk seen from there has at that point of the disk (Heitz 2018, "Sampling the
// GGX Distribution of Visible Normals").
Slope ggx_slope(Point point, double sine, double cosine) {
    const double edge = std::sqrt(1 - square(point.x)), share = (1 + cosine) / 2;
    const double y = edge + share * (point.y - edge), z = std::sqrt(std::max(0., 1 - square(point.x) - square(y)));
    const double height = 1 / (sine * y + cosine * z);
    return {(cosine * y - sine * z) * height, point.x * height};
}

class Facets {
public:
    Facets(double alpha, bool ggx, int points) : alpha_(alpha), ggx_(ggx), rule_(gauss_legendre(points)) {
        const size_t half = rule_.points.size() / 2;
        for (size_t i = 0; i < half; i++) // one half of the slopes across mirrors the other
            across_.push_back(beckmann_slope(rule_.points[i], 0, 1));
        for (size_t i = 0; i < half && ggx_; i++)
            for (const double v : rule_.points)
                disk_.push_back(disk_point(rule_.points[i], v));
    }

    // The mean over the facets that are visible at that cosine of take(normal_z, cosine), which gets the normal's z and
    // the cosine of incidence.
    template <class Take> double mean(double cosine, Take take) const {
        const double sine = std::sqrt(1 - square(cosine)), length = std::hypot(alpha_ * sine, cosine);
        const double stretched_sine = alpha_ * sine / length, stretched_cosine = cosine / length;
        const size_t count = rule_.points.size();
        double sum = 0;
        for (size_t i = 0; i < count; i++) {
            const double along = ggx_ ? 0 : beckmann_slope(rule_.points[i], stretched_sine, stretched_cosine);
            for (size_t k = 0; k < count / 2; k++) {
                const Slope slope =
                    ggx_ ? ggx_slope(disk_[k * count + i], stretched_sine, stretched_cosine) : Slope{along, across_[k]};
                const double x = alpha_ * slope.along, y = alpha_ * slope.across, z = 1 / std::sqrt(1 + x * x + y * y);
                sum += 2 * rule_.weights[i] * rule_.weights[k] * take(z, (cosine - sine * x) * z);
            }
        }
        return sum;
    }

    // Smith's G1 of a direction of that z (cl/bsdfs/microfacet_distribution.cl).
    double masking(double z) const {
        const double c = std::abs(z), s = alpha_ * std::sqrt(std::max(0., 1 - z * z));
        if (ggx_)
            return 2 * c / (c + std::hypot(c, s));
        return c < 1.6 * s ? c * (3.535 * s + 2.181 * c) / (s * s + c * (2.276 * s + 2.577 * c)) : 1;
    }

    // What they reflect of light at that cosine, and what they transmit; eta: relative index of the other side.
    double reflected(double cosine, double eta) const {
        return mean(cosine, [&](double normal_z, double incidence) {
            const double z = 2 * incidence * normal_z - cosine;
            return z > 0 ? masking(z) * Fresnel(incidence, eta).reflectance : 0;
        });
    }
    double transmitted(double cosine, double eta) const {
        return mean(cosine, [&](double normal_z, double incidence) {
            const Fresnel fresnel(incidence, eta);
            const double z = (incidence / eta - fresnel.refracted) * normal_z - cosine / eta;
            return z < 0 ? masking(z) * (1 - fresnel.reflectance) : 0;
        });
    }

private:
    double alpha_;
    bool ggx_;
    Rule rule_;
    std::vector<double> across_; // Beckmann's slopes
    std::vector<Point> disk_;    // of GGX
};

} // namespace

double diffuse_reflectance_fit(double eta) {
    if (eta < 1)
        return 0.6681 + eta * (0.7099 - 1.4399 * eta) + 0.0636 / eta;
    double fit = 0;
    for (const double coefficient : {-1.36881, 4.98554, -7.80989, 6.75335, -3.4793, 0.919317})
        fit = fit / eta + coefficient;
    return fit;
}

double diffuse_reflectance(double eta) {
    const double critical = eta < 1 ? std::sqrt(1 - square(eta)) : 0; // below this cosine all is reflected
    const Rule rule = gauss_legendre(64);
    double sum = square(critical);
    for (size_t i = 0; i < rule.points.size(); i++) { // over the root of what the cosine is above it: that is smooth
        const double root = rule.points[i], cosine = critical + (1 - critical) * square(root);
        sum += rule.weights[i] * 2 * root * (1 - critical) * 2 * cosine * Fresnel(cosine, eta).reflectance;
    }
    return sum;
}

std::vector<float> plastic_boundary(const bsdf_plastic_record &plastic) {
    return {float(diffuse_reflectance_fit(double(plastic.ext_ior.value) / plastic.int_ior.value))};
}

std::vector<float> plastic_boundary(const bsdf_roughplastic_record &plastic) {
    const double eta = double(plastic.int_ior.value) / plastic.ext_ior.value;
    const double alpha = std::max(plastic.alpha.value, LEAST_ALPHA);
    const auto points = [](double index) { return index > 1 ? 32 : 128; }; // more where some light is all reflected
    const Facets from_outside(alpha, plastic.ggx, points(eta)), from_inside(alpha, plastic.ggx, points(1 / eta));
    constexpr int cosines = PLASTIC_COSINES;
    std::vector<float> numbers(PLASTIC_TRANSMITTED + cosines);
    double sum = 0;
    for (int i = 0; i < cosines; i++) {
        const double cosine = std::max(1e-6, i / double(cosines - 1));
        numbers[size_t(PLASTIC_TRANSMITTED + i)] = float(from_outside.transmitted(cosine, eta));
        sum += 2 * cosine * from_inside.reflected(cosine, 1 / eta);
    }
    numbers[PLASTIC_INSIDE] = float(sum / cosines);
    return numbers;
}

} // namespace opal
