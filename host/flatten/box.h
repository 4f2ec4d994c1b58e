// Axis-aligned boxes of floats. Vertices are floats, so that minimum and maximum are exact and nothing needs padding.
#pragma once

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

} // namespace opal
