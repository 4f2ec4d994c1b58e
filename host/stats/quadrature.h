// Adaptive quadrature in double, in one and two dimensions. The integrand is evaluated at many points at once, one call
// a round of subdivision, because densities are computed on the device.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace opal::stats {

struct Point2 {
    double x = 0, y = 0;
};

struct Rectangle {
    double x0 = 0, x1 = 1, y0 = 0, y1 = 1;
    double area() const { return (x1 - x0) * (y1 - y0); }
};

struct Integral {
    double value = 0;
    double error = 0;       // absolute, estimated; an upper bound for smooth integrands
    bool converged = false; // error <= max(relative |value|, absolute), and the value is finite
};

struct QuadratureOptions {
    double relative = 1e-8, absolute = 0;
    size_t max_evaluations = 4'000'000;
    // The first subdivision: places where the integrand has an edge or a peak. A peak much narrower than its piece
    // would be missed.
    std::vector<double> splits_x, splits_y;
};

// Split points about a peak: `center`, and center +- width 4^k, k = 0, 1, ..., as far as they lie within (low, high).
std::vector<double> splits_about(double center, double width, double low, double high);

using Function1 = std::function<double(double)>;
using Function2 = std::function<double(Point2)>;
using BatchFunction2 = std::function<void(std::span<const Point2> points, std::span<double> values)>;

// Integral of f over [a, b], a <= b: Gauss-Kronrod (7, 15) on bisected pieces (Piessens et al., "QUADPACK", 1983).
Integral integrate(const Function1 &f, double a, double b, const QuadratureOptions &options = {});

// Integral of f over each rectangle: the tensor product of the same rule, 225 points a piece. A piece whose error is
// above its share is halved along the axis that causes the more of it (the two one-dimensional differences of Kronrod
// and Gauss). The tolerances hold for each rectangle; max_evaluations for all together.
std::vector<Integral> integrate_cells(const BatchFunction2 &f, std::span<const Rectangle> cells,
                                      const QuadratureOptions &options = {});
Integral integrate(const Function2 &f, const Rectangle &rectangle, const QuadratureOptions &options = {});

} // namespace opal::stats
