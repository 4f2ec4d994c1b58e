// Histograms on the domains: right sampling passes and gives uniform p-values, wrong densities and wrong samples are
// rejected.
#include "base/error.h"
#include "stats/histogram.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>

using namespace opal;
using namespace opal::stats;

namespace {

constexpr double pi = std::numbers::pi, level = 1e-3;
constexpr DomainKind kinds[] = {DomainKind::square,   DomainKind::biunit,     DomainKind::disk,
                                DomainKind::triangle, DomainKind::hemisphere, DomainKind::sphere};

// The textbook's uniform sampling, rounded to float as a device would; not by way of the domain's own map.
Vec3 uniform_point(DomainKind kind, double a, double b) {
    double phi = 2 * pi * b, z = kind == DomainKind::sphere ? 2 * a - 1 : a;
    switch (kind) {
    case DomainKind::square:
        return {a, b, 0};
    case DomainKind::biunit:
        return {2 * a - 1, 2 * b - 1, 0};
    case DomainKind::disk:
        return {std::sqrt(a) * std::cos(phi), std::sqrt(a) * std::sin(phi), 0};
    case DomainKind::triangle: // Osada et al.: fold the square's other half back
        return a + b > 1 ? Vec3{1 - a, 1 - b, 0} : Vec3{a, b, 0};
    default:
        return {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
    }
}

template <class Warp> Histogram sample(DomainKind kind, int n, unsigned seed, Warp warp) {
    Histogram histogram(Grid{&domain(kind), 10, 20});
    std::mt19937_64 rng(seed);
    std::uniform_real_distribution<double> uniform;
    for (int i = 0; i < n; ++i) {
        double a = uniform(rng), b = uniform(rng);
        Vec3 p = warp(a, b);
        histogram.add({float(p.x), float(p.y), float(p.z)});
    }
    return histogram;
}

Vec3 cosine_direction(double a, double b) { return spherical_direction(std::sqrt(a), 2 * pi * b); }
double cosine_pdf(Vec3 d) { return d.z / pi; }

Histogram uniform_sample(DomainKind kind, int n, unsigned seed) {
    return sample(kind, n, seed, [&](double a, double b) { return uniform_point(kind, a, b); });
}

} // namespace

TEST_CASE("domains: there and back, and what lies outside", "[stats_histogram]") {
    for (DomainKind kind : kinds) {
        const Domain &d = domain(kind);
        CAPTURE(d.name);
        CHECK(&domain(d.name) == &d);
        const Rectangle &r = d.bounds;
        for (double s : {0.0001, 0.2, 0.77, 0.9999})
            for (double t : {0.0001, 0.3, 0.9999}) {
                Point2 uv = {r.x0 + s * (r.x1 - r.x0), r.y0 + t * (r.y1 - r.y0)};
                auto back = to_rectangle(d, from_rectangle(d, uv));
                REQUIRE(back);
                CHECK(back->x == Approx(uv.x));
                CHECK(back->y == Approx(uv.y));
            }
        CHECK_FALSE(to_rectangle(d, {NAN, 0, 0}));
        CHECK_FALSE(to_rectangle(d, {0, NAN, 0}));
        CHECK_FALSE(to_rectangle(d, {1.001, 0.5, 0}));
        CHECK_FALSE(to_rectangle(d, {-1.001, 0.5, 0}));
    }
    CHECK_FALSE(to_rectangle(domain("hemisphere"), {0, 0.6, -0.8}));
    CHECK_FALSE(to_rectangle(domain("sphere"), {0, 0, 0.999}));
    CHECK_FALSE(to_rectangle(domain("triangle"), {0.6, 0.6, 0}));
    CHECK_THROWS_AS(domain("cube"), Error);
    CHECK(domain("disk").measure() == Approx(pi));
    CHECK(domain("triangle").measure() == Approx(0.5));
    CHECK(domain("sphere").measure() == Approx(4 * pi));
}

TEST_CASE("uniform samples pass on each domain; two per cent of them elsewhere do not", "[stats_histogram]") {
    for (DomainKind kind : kinds) {
        CAPTURE(domain(kind).name);
        double measure = domain(kind).measure();
        Histogram right = uniform_sample(kind, 200000, 1);
        CHECK_FALSE(density_test(right, each([&](Vec3) { return 1 / measure; })).result.rejected(level));
        CHECK(density_test(right, each([&](Vec3) { return 1.02 / measure; })).result.rejected(level));
        Vec3 spot = from_rectangle(domain(kind), {0.5, 0.5}); // 2 % of the samples there
        Histogram heap = sample(kind, 200000, 1, [&, i = 0](double a, double b) mutable {
            return ++i % 50 ? uniform_point(kind, a, b) : spot;
        });
        CHECK(density_test(heap, each([&](Vec3) { return 1 / measure; })).result.rejected(level));
    }
}

TEST_CASE("p-values of a right pair of sample and density are uniform", "[stats_histogram]") {
    std::vector<double> p;
    for (unsigned seed = 0; seed < 100; ++seed)
        p.push_back(density_test(sample(DomainKind::hemisphere, 5000, seed, cosine_direction), each(cosine_pdf))
                        .result.p_value);
    CHECK_FALSE(ks_uniform_test(p).rejected(level));
}

TEST_CASE("wrong densities of the cosine hemisphere are rejected", "[stats_histogram]") {
    Histogram h = sample(DomainKind::hemisphere, 1000000, 7, cosine_direction);
    auto rejected = [&](std::function<double(Vec3)> pdf) { return density_test(h, each(pdf)).result.rejected(level); };
    CHECK_FALSE(rejected(cosine_pdf));
    CHECK(rejected([](Vec3) { return 1 / (2 * pi); }));                        // the cosine dropped
    CHECK(rejected([](Vec3 d) { return 1.02 * d.z / pi; }));                   // off by 2 %
    CHECK(rejected([](Vec3 d) { return 0.98 * d.z / pi + 0.02 / (2 * pi); })); // 2 % of it uniform
    CHECK(rejected([](Vec3 d) { return d.z / pi * (1 + 0.02 * d.x); }));       // 2 % towards x
    CHECK(rejected([](Vec3 d) { return 3 * d.z * d.z / (2 * pi); }));          // a wrong power
    CHECK(rejected([](Vec3 d) { return d.x > 0 ? 2 * d.z / pi : 0; }));        // hits where it is zero
    CHECK(rejected([](Vec3 d) { return d.z > 0.99 ? NAN : d.z / pi; }));
    CHECK(rejected([](Vec3 d) { return d.z / pi - (d.z < 0.1 ? 0.5 : 0); })); // negative
    Histogram outside = h;
    outside.add({0, 0, -1});
    CHECK(density_test(outside, each(cosine_pdf)).result.p_value == 0);
    Histogram nan = h;
    nan.add({NAN, 0, 1});
    CHECK(density_test(nan, each(cosine_pdf)).result.p_value == 0);
}

TEST_CASE("draws without a sample", "[stats_histogram]") {
    Histogram h = sample(DomainKind::hemisphere, 75000, 8, cosine_direction);
    for (int i = 0; i < 25000; ++i)
        h.add_failed();
    auto density = [](double mass) { return each([=](Vec3 d) { return mass * cosine_pdf(d); }); };
    CHECK_FALSE(density_test(h, density(0.75), true).result.rejected(level));
    CHECK(density_test(h, density(0.75), false).result.p_value == 0);
    CHECK(density_test(h, density(0.77), true).result.rejected(level));
    CHECK(density_test(h, density(1), true).result.p_value == 0);
    Histogram whole = sample(DomainKind::hemisphere, 75000, 9, cosine_direction);
    CHECK_FALSE(density_test(whole, density(1), true).result.rejected(level));
}

TEST_CASE("a very peaked density: found where the caller says where it is", "[stats_histogram]") {
    constexpr double alpha = 1e-5, theta = 1.2; // a tilted Gaussian lobe, narrower than a cell by ten thousand times
    Vec3 axis = spherical_direction(std::cos(theta), pi), t = {std::cos(theta), 0, std::sin(theta)}, b = {0, 1, 0};
    auto lobe = [&](double u, double v) { // by the tangents' plane: d = axis + x t + y b, normalised
        double r = alpha * std::sqrt(-2 * std::log1p(-u)), x = r * std::cos(2 * pi * v), y = r * std::sin(2 * pi * v);
        return normalize(axis + t * x + b * y);
    };
    auto pdf = [&](double width) {
        return each([=](Vec3 d) {
            double c = dot(d, axis), x = dot(d, t) / c, y = dot(d, b) / c;
            return c <= 0 ? 0 : std::exp(-(x * x + y * y) / (2 * width * width)) / (2 * pi * width * width * c * c * c);
        });
    };
    Histogram h = sample(DomainKind::hemisphere, 100000, 10, lobe);
    // The lobe lies about phi = pi, an edge of the grid: half of it in each of two cells.
    auto su = splits_about(axis.z, alpha, 0, 1), sv = splits_about(pi, alpha, 0, 2 * pi);
    DensityTest right = density_test(h, pdf(alpha), false, su, sv);
    CHECK(right.mass.value == Approx(1).epsilon(1e-5));
    CHECK_FALSE(right.result.rejected(level));
    CHECK(density_test(h, pdf(alpha)).result.rejected(level)); // not seen without the hint: never a pass
    auto shifted = [&](std::span<const Vec3> points, std::span<double> values) {
        pdf(alpha)(points, values);
        for (size_t i = 0; i < points.size(); ++i)
            values[i] *= 1 + (points[i].y > 0 ? 0.02 : -0.02);
    };
    CHECK(density_test(h, shifted, false, su, sv).result.rejected(level));
}
