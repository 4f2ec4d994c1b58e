// Cuts polygons into triangles.
#pragma once

#include "base/math.h"

#include <array>
#include <vector>

namespace opal {

// Triangles of a polygon, as indices of corners, by ear clipping (Meisters 1975) in the plane of its Newell normal. A
// convex polygon becomes the fan around its first corner, as in Nori. Always gives corners - 2 triangles. Error: more
// than max_concave_corners, and not convex.
constexpr unsigned max_concave_corners = 10000;
std::vector<std::array<unsigned, 3>> triangulate(const std::vector<Vec3> &corners);

} // namespace opal
