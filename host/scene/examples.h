// Small scenes' parts, in memory: shapes, materials, a camera. `opal selftest`, `opal extremes` and the tests build
// their scenes of them.
#pragma once

#include "scene/scene.h"

namespace opal::examples {

// A camera at `from` that looks at `to`, with that full horizontal angle in degrees. It clips nothing and has a box
// filter; the resolution is the default one.
Camera camera(Vec3 from, Vec3 to, double fov);

// Grey materials. Indices of refraction are those inside; outside is a vacuum.
Bsdf diffuse(double albedo, bool use_cosine = true);
Bsdf mirror();
Bsdf dielectric(double int_ior = 1.5);
Bsdf microfacet(double alpha, double kd = 0.3);        // index 1.5
Bsdf principled(double roughness);                     // half metal, half glass, with a clear coat
Bsdf phong(double exponent, double reflectance = 0.5); // kd = ks = reflectance; half of the samples are diffuse

// A small sky with a sun, over dark ground.
std::shared_ptr<const EnvironmentMap> environment();

// Triangles without vertex normals, by their corners' indices.
TriangleMesh mesh_of(const std::vector<Vec3> &positions, const std::vector<std::array<unsigned, 3>> &triangles);
// The parallelogram o, o + u, o + u + v, o + v as two triangles; its front side is u x v.
TriangleMesh quad(Vec3 o, Vec3 u, Vec3 v);
// An axis-parallel cube of 12 triangles.
TriangleMesh cube(Vec3 center, double half_side, bool inwards = false);

Mesh made_of(Shape shape, const Bsdf &bsdf);
// A grey area light that reflects nothing; radiance in W / (m^2 sr).
Mesh light(Shape shape, double radiance);

} // namespace opal::examples
