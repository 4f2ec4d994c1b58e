// Polygons cut into triangles: the same ears in the same order as plain ear clipping, but quickly.
#include "read/triangulate.h"
#include "support/error_of.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <random>

using namespace opal;
using opal::test::error_of;

namespace {

using Polygon = std::vector<Vec3>;
using Triangles = std::vector<std::array<unsigned, 3>>;

double turn(Vec3 a, Vec3 b, Vec3 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

double area_of(const Polygon &p) {
    double sum = 0;
    for (size_t i = 1; i + 1 < p.size(); ++i)
        sum += turn(p[0], p[i], p[i + 1]) / 2;
    return sum;
}

// The definition, in cubic time: the first ear after the first corner is cut off; without an ear the second corner.
// For polygons in the plane z = 0.
Triangles plain_ear_clipping(Polygon p) {
    if (area_of(p) < 0)
        for (Vec3 &corner : p)
            std::swap(corner.x, corner.y);
    for (const Vec3 first = p[0]; Vec3 & corner : p)
        corner = corner - first;
    const auto same = [](Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y; };
    std::vector<unsigned> left(p.size());
    for (unsigned i = 0; i < left.size(); ++i)
        left[i] = i;
    const auto corner = [&](size_t i) { return p[left[i % left.size()]]; };
    const auto is_ear = [&](size_t i) {
        const Vec3 a = corner(i), b = corner(i + 1), c = corner(i + 2);
        bool ear = turn(a, b, c) > 0;
        for (size_t k = i + 3; ear && k < i + left.size(); ++k) {
            const Vec3 q = corner(k);
            ear = same(q, a) || same(q, b) || same(q, c) || turn(a, b, q) < 0 || turn(b, c, q) < 0 || turn(c, a, q) < 0;
        }
        return ear;
    };
    Triangles triangles;
    while (left.size() > 3) {
        size_t i = 0;
        while (i < left.size() && !is_ear(i))
            ++i;
        i %= left.size();
        triangles.push_back({left[i], left[(i + 1) % left.size()], left[(i + 2) % left.size()]});
        left.erase(left.begin() + std::ptrdiff_t((i + 1) % left.size()));
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

Vec3 polar(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle), 0}; }

Polygon around(int n, const std::function<double(int)> &radius) {
    Polygon p;
    for (int i = 0; i < n; ++i)
        p.push_back(polar(radius(i), 2 * M_PI * i / n));
    return p;
}

// A corridor that winds around the middle, `sides` corners a turn.
Polygon spiral(int n, double sides) {
    const int half = n / 2;
    const double turns = half / sides;
    Polygon p;
    for (int i = 0; i < half; ++i)
        p.push_back(polar(0.05 + double(i) / half, 2 * M_PI * i / sides));
    for (int i = half; i-- > 0;)
        p.push_back(polar(0.05 + double(i) / half + 0.4 / turns, 2 * M_PI * i / sides));
    return p;
}

Polygon comb(int n) {
    Polygon p;
    for (int i = 0; i < n - 2; ++i)
        p.push_back({double(i / 2), i % 4 == 1 || i % 4 == 2 ? 10. : 0., 0});
    p.push_back({double(n / 2), -1, 0});
    p.push_back({0, -1, 0});
    return p;
}

// An annulus cut open: the outline runs to the hole and back along a bridge.
Polygon ring(int n) {
    const int half = n / 2;
    Polygon p;
    for (int i = 0; i < half; ++i)
        p.push_back(polar(1, 2 * M_PI * i / (half - 1)));
    for (int i = 0; i < half; ++i)
        p.push_back(polar(0.9, -2 * M_PI * i / (half - 1)));
    p[size_t(half) - 1] = p[0];
    p.back() = p[size_t(half)];
    return p;
}

// A square with many corners a side, and a notch.
Polygon straight_runs(int n) {
    const int side = n / 4;
    Polygon p;
    for (int i = 0; i < side; ++i)
        p.push_back({double(i), 0, 0});
    for (int i = 0; i < side; ++i)
        p.push_back({double(side), double(i), 0});
    for (int i = 0; i < side; ++i)
        p.push_back({double(side - i), double(i == side / 2 ? 1 : side), 0});
    for (int i = 0; i < side; ++i)
        p.push_back({0, double(side - i), 0});
    return p;
}

// A narrow band that runs up in long zigzags.
Polygon zigzag(int n) {
    Polygon p;
    for (int i = 0; i < n / 2; ++i)
        p.push_back({i % 2 ? 0. : 1000., double(i), 0});
    for (int i = n / 2; i-- > 0;)
        p.push_back({i % 2 ? 0.3 : 1000.3, double(i), 0});
    return p;
}

// Leaves that all begin and end in the middle.
Polygon flower(int n) {
    Polygon p;
    for (int i = 0; i < n / 3; ++i) {
        p.push_back({0, 0, 0});
        p.push_back(polar(1, 6 * M_PI * i / n));
        p.push_back(polar(1, 6 * M_PI * (i + 0.5) / n));
    }
    return p;
}

struct Family {
    const char *name;
    bool simple; // neither touches nor crosses itself
    std::function<Polygon(int n, std::mt19937 &random)> make;
};

double uniform(std::mt19937 &random) { return std::uniform_real_distribution<>(0, 1)(random); }

const std::vector<Family> families = {
    {"star", true, [](int n, auto &) { return around(n / 2 * 2, [](int i) { return i % 2 ? 1 : 0.4; }); }},
    {"ragged star", true, [](int n, auto &r) { return around(n, [&](int) { return 0.1 + uniform(r); }); }},
    {"spiral", true, [](int n, auto &) { return spiral(n, n / 60. + 3); }},
    {"square spiral", true, [](int n, auto &) { return spiral(n, 4); }},
    {"comb", true, [](int n, auto &) { return comb(n / 4 * 4 + 2); }},
    {"zigzag", true, [](int n, auto &) { return zigzag(n); }},
    {"straight runs", true, [](int n, auto &) { return straight_runs(std::max(n, 16)); }},
    {"ring with a bridge", false, [](int n, auto &) { return ring(std::max(n, 12)); }},
    {"flower", false, [](int n, auto &) { return flower(std::max(n, 12)); }},
    {"crossing itself", false,
     [](int n, auto &r) {
         Polygon p;
         for (int i = 0; i < n; ++i)
             p.push_back({uniform(r), uniform(r), 0});
         return p;
     }},
    {"crossing and touching itself on a lattice", false,
     [](int n, auto &r) {
         Polygon p;
         for (int i = 0; i < n; ++i)
             p.push_back({std::floor(5 * uniform(r)), std::floor(5 * uniform(r)), 0});
         return p;
     }},
    {"a line there and back", false,
     [](int n, auto &) {
         Polygon p;
         for (int i = 0; i < n; ++i)
             p.push_back(polar(std::min(i, n - i), 0.3));
         p.push_back(polar(n, 1));
         return p;
     }},
};

bool is_convex(const Polygon &p) {
    const double sign = area_of(p) < 0 ? -1 : 1;
    for (size_t i = 0; i < p.size(); ++i)
        if (sign * turn(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0)
            return false;
    return true;
}

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

} // namespace

TEST_CASE("polygons become the triangles of plain ear clipping, in its order", "[triangulate]") {
    std::mt19937 random(1);
    for (const Family &family : families) {
        INFO(family.name);
        int concave = 0;
        for (int i = 0; i < 200; ++i) {
            Polygon p = family.make(5 + int(random() % (i % 20 ? 30 : 150)), random);
            std::rotate(p.begin(), p.begin() + std::ptrdiff_t(random() % p.size()), p.end());
            if (random() % 2)
                std::reverse(p.begin(), p.end());
            if (area_of(p) == 0 || is_convex(p))
                continue;
            ++concave;
            REQUIRE(triangulate(p) == plain_ear_clipping(p));
        }
        CHECK(concave > 100);
    }
}

TEST_CASE("10000 corners of any shape are cut in less than a second, and simple outlines are covered once",
          "[triangulate]") {
    std::mt19937 random(1);
    for (const Family &family : families) {
        INFO(family.name);
        Polygon p = family.make(9990, random);
        REQUIRE(p.size() > 9900);
        REQUIRE(p.size() <= max_concave_corners);
        const double start = cpu_seconds();
        const Triangles triangles = triangulate(p);
        CHECK(cpu_seconds() - start < 1);
        CHECK(triangles.size() == p.size() - 2);
        if (!family.simple)
            continue;
        double sum = 0, least = 0;
        const double sign = area_of(p) < 0 ? -1 : 1;
        for (auto [a, b, c] : triangles) {
            const double area = sign * turn(p[a], p[b], p[c]) / 2;
            sum += area;
            least = std::min(least, area);
        }
        CHECK(sum == Approx(std::abs(area_of(p))).epsilon(1e-9));
        CHECK(least > -1e-9 * sum);
    }
}

TEST_CASE("larger polygons are cut where they are convex, and refused where not", "[triangulate]") {
    const int many = 64000;
    CHECK(triangulate(around(many, [](int) { return 1; })).size() == many - 2);
    CHECK(error_of([&] { triangulate(around(many, [](int i) { return i % 2 ? 1 : 0.9; })); }) ==
          "a face of 64000 corners that is not convex: at most 10000 are cut into triangles; triangulate it in the "
          "program that wrote the file");
}
