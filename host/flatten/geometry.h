// From meshes in world space and double precision to triangles of floats around the origin.
#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"
#include "flatten/flat_scene.h"

namespace opal {

// A box in world space, around nothing at first.
struct Extent {
    Vec3 lo{INFINITY, INFINITY, INFINITY}, hi{-INFINITY, -INFINITY, -INFINITY};
    void add(Vec3 p);
    void add(const Extent &other);
    bool empty() const { return lo.x > hi.x; }
    Vec3 middle() const { return lo * 0.5 + hi * 0.5; }
    double longest_side() const; // 0 where empty
};
Extent extent_of(const Mesh &mesh);              // a position that no triangle uses does not count
Extent extent_of(const SceneDescription &scene); // all meshes and point lights

// The map from world positions to flattened ones; distances grow by `scale`, areas by its square.
struct Frame {
    Vec3 center;
    double scale = 1;
    std::array<float, 3> operator()(Vec3 world) const;
};

// Centre of the scene's extent, and the power of two that brings half its longest side into
// (0.5, 1]. A scene of nothing, or of one point, has scale 1.
Frame find_frame(const SceneDescription &scene);

// Fills scene.triangles and scene.normals, and returns the positions. Triangles that the rounding to float leaves
// without a normal are left out, with a warning that counts them.
TriangleSoup gather_triangles(const SceneDescription &description, const Frame &frame, FlatScene &scene);

} // namespace opal
