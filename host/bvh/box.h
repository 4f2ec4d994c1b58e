// Axis-aligned boxes of floats, and the normals of triangles of floats. Vertices are floats, so that minimum and
// maximum are exact and nothing needs padding.
#pragma once

#include "base/math.h"

#include <algorithm>
#include <array>
#include <limits>

namespace opal {

struct Box {
    static constexpr float INF = std::numeric_limits<float>::infinity();
    std::array<float, 3> lo, hi;
    static constexpr Box empty() { return {{INF, INF, INF}, {-INF, -INF, -INF}}; }

    void add(const std::array<float, 3> &point) {
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
    // Half the surface. Not for an empty box.
    float half_area() const {
        const float x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2];
        return x * y + y * z + z * x;
    }
    // Twice the middle.
    float middle2(int axis) const { return lo[axis] + hi[axis]; }
    std::array<float, 3> middle2() const { return {middle2(0), middle2(1), middle2(2)}; }
};

// (b - a) x (c - a), exact but for the rounding of double. Its length is twice the triangle's area.
inline Vec3 normal_of(const std::array<float, 3> &a, const std::array<float, 3> &b, const std::array<float, 3> &c) {
    const auto edge = [&a](const std::array<float, 3> &p) {
        return Vec3{double(p[0]) - a[0], double(p[1]) - a[1], double(p[2]) - a[2]};
    };
    return cross(edge(b), edge(c));
}

} // namespace opal
