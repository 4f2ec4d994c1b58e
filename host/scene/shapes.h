// The shapes of meshes, in world space and double precision. Each kind has the same three functions; what it becomes on
// the device says an overload of add_primitives (flatten/geometry.cpp).
#pragma once

#include "base/large_vector.h"
#include "base/math.h"

#include <array>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

namespace opal {

// An axis-aligned box, empty at first.
struct Extent {
    Vec3 lo{INFINITY, INFINITY, INFINITY}, hi{-INFINITY, -INFINITY, -INFINITY};
    void add(Vec3 p);
    void add(const Extent &other);
    bool empty() const { return lo.x > hi.x; }
    Vec3 middle() const { return lo * 0.5 + hi * 0.5; }
    Vec3 corner(unsigned i) const { return {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; } // of 8
    double longest_side() const; // 0 if empty
    double radius() const;       // of the sphere through the corners; 0 if empty
};

struct TriangleMesh {
    LargeVector<Vec3> positions;
    LargeVector<Vec3> normals; // unit; may be empty
    struct Corner {
        unsigned position, normal;
    };                                            // indices; normal OPAL_NONE: the geometric normal
    LargeVector<std::array<Corner, 3>> triangles; // degenerate ones already dropped
    LargeVector<std::array<float, 2>> uvs;        // texture coordinates, v upwards; may be empty
    // Indices of uvs, one array a triangle, OPAL_NONE where a corner has none; empty where no triangle has any.
    LargeVector<std::array<unsigned, 3>> uv_corners;

    Extent extent() const; // of the positions that triangles use
    TriangleMesh moved(const Transform &by) const;
    // A mesh for each list of triangles, which are given by their indices, in that order and with what they use.
    std::vector<TriangleMesh> parts(const std::vector<std::vector<size_t>> &lists) const;
    std::string text() const; // for people: "12 triangles"
};

struct Parallelogram {
    Vec3 origin, u, v;         // front side u x v
    bool uv_exchanged = false; // texture coordinate u grows along the edge v, and v along u

    std::array<Vec3, 4> corners() const { return {origin, origin + u, origin + v, origin + u + v}; }
    Extent extent() const;
    Parallelogram moved(const Transform &by) const;
    std::string text() const;
};

struct Sphere {
    Vec3 center;
    double radius = 1;
    bool inward = false; // whether its normals point to the centre: it is seen and emits inside
    // Its own axes, unit vectors that may be left-handed. Texture coordinate u is the angle around z from x over 2 pi,
    // v the angle from z over pi.
    std::array<Vec3, 3> axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

    Extent extent() const;
    Sphere moved(const Transform &by) const; // a similarity, which may mirror: that turns the normals
    std::string text() const;
};

// Why a transform makes no sphere of a sphere, for a message; empty: it is a similarity, which may mirror.
std::string why_no_sphere(const Transform &transform);

using Shape = std::variant<TriangleMesh, Parallelogram, Sphere>;

} // namespace opal
