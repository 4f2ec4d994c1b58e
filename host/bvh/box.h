// Points, axis-aligned boxes and triangle normals in flattened units. Coordinates are floats: the minimum and the
// maximum of floats are exact, so that boxes need no padding.
#pragma once

#include "base/math.h"

#include <algorithm>
#include <array>
#include <limits>

namespace opal {

// A position in flattened units.
using Point3f = std::array<float, 3>;

struct Box {
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    Point3f lo, hi;
    // The box of no point: adding a point makes it that point's.
    static constexpr Box empty() { return {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}}; }

    void add(const Point3f &point) {
        for (int axis = 0; axis < 3; axis++) {
            lo[axis] = std::min(lo[axis], point[axis]);
            hi[axis] = std::max(hi[axis], point[axis]);
        }
    }
    void add(const Box &box) {
        for (int axis = 0; axis < 3; axis++) {
            lo[axis] = std::min(lo[axis], box.lo[axis]);
            hi[axis] = std::max(hi[axis], box.hi[axis]);
        }
    }
    std::array<Point3f, 8> corners() const {
        std::array<Point3f, 8> all;
        for (std::size_t i = 0; i < 8; i++)
            all[i] = {i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]};
        return all;
    }
    // Half the surface area, in squared units. The box must not be empty.
    float half_area() const {
        const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
        return x * y + y * z + z * x;
    }
    // Twice the centre: comparisons of centres need no division.
    float twice_center(int axis) const { return lo[axis] + hi[axis]; }
    Point3f twice_center() const { return {twice_center(0), twice_center(1), twice_center(2)}; }
};

// The unnormalised normal (b - a) x (c - a), computed in double. Its length is twice the triangle's area.
inline Vec3 normal_of(const Point3f &a, const Point3f &b, const Point3f &c) {
    const auto edge = [&a](const Point3f &p) {
        return Vec3{double(p[0]) - a[0], double(p[1]) - a[1], double(p[2]) - a[2]};
    };
    return cross(edge(b), edge(c));
}

} // namespace opal
