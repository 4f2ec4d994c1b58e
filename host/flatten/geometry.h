// Flattening of positions: from meshes in world space and double precision to triangles of floats around the origin.
#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"
#include "flatten/flat_scene.h"

namespace opal {

// An axis-aligned box in world space, empty at first.
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
Extent extent_of(const Mesh &mesh);              // of the positions that triangles use
Extent extent_of(const SceneDescription &scene); // of all meshes and lights, without the camera

// The map from world space to flattened units, (position - center) * scale. Distances grow by the factor `scale`, areas
// by its square; directions stay. The scale is a power of two, so that nothing but the subtraction rounds in double.
struct Flattening {
    Vec3 center;
    double scale = 1;
    Point3f operator()(Vec3 world) const; // rounds to float
};

// Maps the centre of the scene's extent to the origin and half of its longest side into (0.5, 1]. An empty scene and a
// scene of one point have scale 1.
Flattening find_flattening(const SceneDescription &scene);

// Fills scene.triangles and scene.normals and returns the flattened positions. A triangle whose normal is lost in the
// rounding to float is dropped; one warning counts all of them.
TriangleSoup gather_triangles(const SceneDescription &description, const Flattening &flattening, FlatScene &scene);

} // namespace opal
