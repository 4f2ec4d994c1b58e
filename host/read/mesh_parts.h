// What the readers of meshes share: coordinates from text, triangles without area, and the entries that triangles use.
#pragma once

#include "base/large_vector.h"
#include "base/math.h"
#include "scene/shapes.h"
#include "shared/types.h"

#include <string>
#include <string_view>

namespace opal {

// A number that is finite, also in single precision; throws Error that quotes the word.
double parse_coordinate(std::string_view word);

// The same, but NaN where infinity or NaN is written, also as Windows' old C library did: 1.#QNAN.
double parse_coordinate_or_nan(std::string_view word);

// How far rounding the coordinates to double may move the corners of a triangle.
double rounding_of(const std::array<Vec3, 3> &triangle);

// A triangle has no area if its height over the longest edge may be due to rounding.
bool has_area(const std::array<Vec3, 3> &triangle, double rounding);

// What a reader has dropped: triangles without area, and faces of one or two corners.
struct DroppedTriangles {
    size_t count = 0;
    double rounding = 0;     // the largest of them; 0 if they are all faces of too few corners
    std::string first_place; // "file:line:col"
    std::string first_object;
};

// Warns of them, or that a mesh has no triangles at all.
void warn_of_dropped(const std::string &file, const DroppedTriangles &dropped, const TriangleMesh &mesh);

// Whether a point is finite in single precision.
bool fits_float(Vec3 p);

// A normal in world space, of unit length; zero where it has no direction.
Vec3 unit_normal(const Transform &to_world, Vec3 normal);

// Keeps the entries that corners of `triangles` refer to by index_of(corner), renumbered in the order of their first
// use.
template <class Entry, class Triangles, class IndexOf>
LargeVector<Entry> compact(const LargeVector<Entry> &all, Triangles &triangles, const IndexOf &index_of) {
    LargeVector<Entry> used;
    LargeVector<unsigned> renumbered(all.size(), OPAL_NONE);
    for (auto &triangle : triangles)
        for (auto &corner : triangle) {
            unsigned &index = index_of(corner);
            if (index == OPAL_NONE)
                continue;
            if (renumbered[index] == OPAL_NONE) {
                renumbered[index] = unsigned(used.size());
                used.push_back(all[index]);
            }
            index = renumbered[index];
        }
    return used;
}

} // namespace opal
