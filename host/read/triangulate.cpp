#include "read/obj.h"

#include <numeric>

namespace opal {

namespace {

struct Point2 {
    double x, y;
};

// Twice the signed area of abc, positive counter-clockwise.
double turn(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Newell's method (Sutherland, Sproull and Schumacher 1974): the area vector of any polygon, doubled.
Vec3 area_vector(const std::vector<Vec3> &corners) {
    Vec3 sum;
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        sum = sum + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return sum;
}

// Projects along the axis in which the polygon is flattest, and keeps it counter-clockwise.
std::vector<Point2> projected(const std::vector<Vec3> &corners) {
    Vec3 n = area_vector(corners);
    double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    int drop = x > y && x > z ? 0 : y > z ? 1 : 2;
    int first = (drop + 1) % 3, second = (drop + 2) % 3;
    if (n[drop] < 0)
        std::swap(first, second);
    std::vector<Point2> points;
    for (Vec3 corner : corners)
        points.push_back({corner[first] - corners[0][first], corner[second] - corners[0][second]});
    return points;
}

bool same(Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }

// The part of the polygon that is not cut off yet, as indices of its points.
struct Clipper {
    const std::vector<Point2> &points;
    std::vector<unsigned> left;

    unsigned at(size_t i) const { return left[i % left.size()]; }

    // Whether the corner after `i` is an ear: convex, with no other corner in its triangle.
    bool is_ear(size_t i) const {
        Point2 a = points[at(i)], b = points[at(i + 1)], c = points[at(i + 2)];
        if (!(turn(a, b, c) > 0))
            return false;
        for (size_t k = i + 3; k < i + left.size(); ++k) {
            Point2 p = points[at(k)];
            bool is_corner = same(p, a) || same(p, b) || same(p, c);
            if (!is_corner && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0)
                return false;
        }
        return true;
    }

    // Without an ear (collinear corners, an outline that crosses itself) any corner is cut off.
    size_t find_ear() const {
        for (size_t i = 0; i < left.size(); ++i)
            if (is_ear(i))
                return i;
        return 0;
    }

    std::array<unsigned, 3> clip(size_t i) {
        std::array<unsigned, 3> ear = {at(i), at(i + 1), at(i + 2)};
        left.erase(left.begin() + std::ptrdiff_t((i + 1) % left.size()));
        return ear;
    }
};

bool is_convex(const std::vector<Point2> &points) {
    size_t n = points.size();
    for (size_t i = 0; i < n; ++i)
        if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0)
            return false;
    return true;
}

} // namespace

std::vector<std::array<unsigned, 3>> triangulate(const std::vector<Vec3> &corners) {
    std::vector<std::array<unsigned, 3>> triangles;
    unsigned count = static_cast<unsigned>(corners.size());
    std::vector<Point2> points;
    if (count > 3)
        points = projected(corners);
    if (is_convex(points)) {
        for (unsigned i = 2; i < count; ++i)
            triangles.push_back({0, i - 1, i});
        return triangles;
    }
    Clipper clipper{points, std::vector<unsigned>(count)};
    std::iota(clipper.left.begin(), clipper.left.end(), 0u);
    while (clipper.left.size() > 3)
        triangles.push_back(clipper.clip(clipper.find_ear()));
    triangles.push_back({clipper.left[0], clipper.left[1], clipper.left[2]});
    return triangles;
}

} // namespace opal
