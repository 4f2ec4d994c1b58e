// Flattening of positions: from meshes in world space and double precision to primitives of floats around the origin.
#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"
#include "flatten/flat_scene.h"

#include <functional>
#include <limits>

namespace opal {

Extent extent_of(const Mesh &mesh);
Extent extent_of(const SceneDescription &scene); // of all meshes and lights, without the camera

// The map from world space to flattened units, (position - center) * scale. Distances grow by the factor `scale`, areas
// by its square; directions stay. The scale is a power of two, so that nothing but the subtraction rounds in double.
struct Flattening {
    Vec3 center;
    double scale = 1;
    Point3f operator()(Vec3 world) const; // rounds to float
    float distance(double world) const { return float(world * scale); }
};

// Whether a device meets a sphere of that radius, in flattened units: its square must not be denormal.
inline bool has_area(float radius) { return radius * radius >= std::numeric_limits<float>::min(); }

// Maps the centre of the scene's extent to the origin and half of its longest side into (0.5, 1]. An empty scene and a
// scene of one point have scale 1.
Flattening find_flattening(const Extent &extent);

// Fills scene.triangles and scene.normals, and of other shapes NAME_blocks with a block for each primitive, and returns
// what the tree is built over. A triangle whose normal is lost in the rounding to float is dropped, and a sphere whose
// area is; one warning counts all of them. on_gathered(i) is called once mesh i is needed no longer.
TriangleSoup gather_primitives(const SceneDescription &description, const Flattening &flattening, FlatScene &scene,
                               const std::function<void(uint)> &on_gathered);

} // namespace opal
