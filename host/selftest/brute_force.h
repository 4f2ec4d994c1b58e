// Rays against every triangle and sphere of a scene in double: what the kernels' closest and any hit are held against.
#pragma once

#include "probe/kernel_probe.h"

namespace opal {

// A ray o + t d, tmin < t < tmax, in a flattened scene. d need not be of unit length.
struct HostRay {
    Vec3 o, d;
    double tmin, tmax;
};

// A triangle of a flattened scene, as the device has it.
struct SlotTriangle {
    uint slot;
    std::array<Vec3, 3> corners;
};
std::vector<SlotTriangle> triangles_by_slot(const FlatScene &scene);

// A sphere, likewise; slots of both shapes count from 0.
struct SlotSphere {
    uint slot;
    Vec3 center;
    double radius;
};
std::vector<SlotSphere> spheres_by_slot(const FlatScene &scene);

// Rays as the probe takes them; rounds `rays` to the floats that the device gets.
Planes planes_of_rays(std::vector<HostRay> &rays);

// Rays through [-1, 1]^3, about which a flattened scene lies: directions of any length, along axes and planes too, with
// near and far bounds.
std::vector<HostRay> random_rays(size_t count, unsigned seed);

// How many rays the device answers in a way that no rounding explains. Rays that pass too near an edge or a bound to
// tell are judged by what all triangles agree on.
struct HitErrors {
    size_t closest = 0, any = 0; // the primitive or its distance; whether anything is in the way
    size_t weights = 0;          // u and v of the hit
    size_t hits = 0;             // right or wrong
};
HitErrors errors_of_hits(KernelProbe &probe, std::vector<HostRay> rays);

// How many of these rays, each of which must hit something, meet nothing, be it as closest or as any hit.
size_t lost_among(KernelProbe &probe, std::vector<HostRay> rays);

// Triangles of random corners, each within a cube of half side `size` around a random point of [-1, 1]^3.
SceneDescription triangle_soup(size_t triangles, double size, unsigned seed);

// Spheres around random points of [-1, 1]^3, whose radii are even in their logarithm; every other one is inward.
SceneDescription sphere_soup(size_t spheres, double least, double most, unsigned seed);

// A scene of one mesh.
SceneDescription scene_of_mesh(TriangleMesh mesh);

} // namespace opal
