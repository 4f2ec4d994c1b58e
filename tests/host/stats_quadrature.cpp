// Quadrature against integrals known in closed form; its stated error must hold, and a spike must be found.
#include "stats/quadrature.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace opal::stats;

namespace {

constexpr double pi = std::numbers::pi;

void check(const Integral &integral, double truth) {
    CHECK(integral.converged);
    CHECK(std::abs(integral.value - truth) <= integral.error + 1e-14 * std::abs(truth));
    CHECK(integral.value == Approx(truth).epsilon(1e-7));
}

double gauss(double x, double center, double sigma) {
    return std::exp(-(x - center) * (x - center) / (2 * sigma * sigma)) / (sigma * std::sqrt(2 * pi));
}

} // namespace

TEST_CASE("Kronrod's rule is exact for polynomials to degree 23", "[stats_quadrature]") {
    for (int degree = 0; degree <= 23; ++degree) {
        QuadratureOptions once;
        once.max_evaluations = 15;
        Integral i = integrate([&](double x) { return std::pow(x, degree); }, 0, 1, once);
        CHECK(i.value == Approx(1.0 / (degree + 1)).epsilon(1e-14));
        CHECK((i.error < 1e-14) == (degree <= 13)); // Gauss's rule of 7 points ends there
    }
}

TEST_CASE("integrals in one dimension", "[stats_quadrature]") {
    check(integrate([](double x) { return std::sin(x); }, 0, pi), 2);
    check(integrate([](double x) { return std::sqrt(x); }, 0, 1), 2.0 / 3);
    check(integrate([](double x) { return x < 0.3 ? 1.0 : 0.0; }, 0, 1), 0.3);
    check(integrate([](double x) { return gauss(x, 0.37, 1e-3); }, 0, 1), 1);
    QuadratureOptions split;
    split.splits_x = splits_about(0.2517, 1e-7, 0, 1);
    check(integrate([](double x) { return gauss(x, 0.2517, 1e-7); }, 0, 1, split), 1);
    CHECK(integrate([](double) { return 1.0; }, 2, 2).value == 0);
}

TEST_CASE("integrals in two dimensions", "[stats_quadrature]") {
    Rectangle unit;
    check(integrate([](Point2 p) { return p.x * p.y * p.y; }, Rectangle{0, 2, 0, 3}), 18);
    check(integrate([](Point2 p) { return std::exp(p.x + p.y); }, unit), std::pow(std::numbers::e - 1, 2));
    QuadratureOptions rough;
    rough.relative = 1e-4;
    Integral disk = integrate([](Point2 p) { return p.x * p.x + p.y * p.y < 1 ? 1.0 : 0.0; }, unit, rough);
    CHECK(disk.converged);
    CHECK(std::abs(disk.value - pi / 4) < disk.error);
    // A narrow ridge that no axis follows, and a spike of width 1e-5 that only split points find.
    check(integrate([](Point2 p) { return gauss(p.x - p.y, 0, 0.01); }, Rectangle{-1, 1, 0, 0.5}), 0.5);
    auto spike = [](Point2 p) { return gauss(p.x, 0.3, 1e-5) * gauss(p.y, 0.6, 1e-5); };
    CHECK(integrate(spike, unit).value < 0.5); // the negative control: it is not seen without
    QuadratureOptions split;
    split.splits_x = splits_about(0.3, 1e-5, 0, 1);
    split.splits_y = splits_about(0.6, 1e-5, 0, 1);
    check(integrate(spike, unit, split), 1);
}

TEST_CASE("solid angles: densities over (cos theta, phi) integrate to 1", "[stats_quadrature]") {
    Rectangle hemisphere{0, 1, 0, 2 * pi};
    check(integrate([](Point2 p) { return p.x / pi; }, hemisphere), 1); // cosine
    double alpha = 0.01; // Beckmann's distribution of normals times the cosine
    auto beckmann = [&](Point2 p) {
        double c2 = p.x * p.x, tan2 = (1 - c2) / c2;
        return std::exp(-tan2 / (alpha * alpha)) / (pi * alpha * alpha * c2 * c2) * p.x;
    };
    QuadratureOptions split;
    split.splits_x = splits_about(1, alpha * alpha, 0, 1);
    check(integrate(beckmann, hemisphere, split), 1);
    auto dropped_cosine = [&](Point2 p) { return beckmann(p) / p.x; };
    CHECK_FALSE(integrate(dropped_cosine, hemisphere, split).value == Approx(1).epsilon(2e-5)); // 1 + alpha^2 / 2
}

TEST_CASE("cells of one call: each its own tolerance, few calls", "[stats_quadrature]") {
    int calls = 0;
    auto f = [&](std::span<const Point2> points, std::span<double> values) {
        ++calls;
        for (size_t i = 0; i < points.size(); ++i)
            values[i] = points[i].x < 1 ? points[i].y : gauss(points[i].x, 1.5, 1e-3);
    };
    auto cells = integrate_cells(f, std::vector<Rectangle>{{0, 1, 0, 1}, {1, 2, 0, 1}});
    check(cells[0], 0.5);
    check(cells[1], 1);
    CHECK(calls < 40);
}

TEST_CASE("what is no number, or too hard, is not called converged", "[stats_quadrature]") {
    auto nan = [](double x) { return x < 0.9 ? 1.0 : NAN; };
    CHECK_FALSE(integrate(nan, 0, 1).converged);
    CHECK(std::isnan(integrate(nan, 0, 1).value));
    CHECK_FALSE(integrate([](Point2 p) { return 1 / (p.x - 0.5); }, Rectangle{}).converged); // infinite at a node
    CHECK_FALSE(integrate([](Point2) { return NAN; }, Rectangle{}).converged);
    auto silent = [](std::span<const Point2>, std::span<double>) {}; // a device that writes nothing
    CHECK_FALSE(integrate_cells(silent, std::vector<Rectangle>{{}})[0].converged);
    QuadratureOptions few;
    few.max_evaluations = 1000;
    CHECK_FALSE(integrate([](Point2 p) { return p.x + p.y < 0.77 ? 1.0 : 0.0; }, Rectangle{}, few).converged);
    CHECK_FALSE(integrate([](double x) { return std::sin(1 / x); }, 1e-9, 1, few).converged);
}
