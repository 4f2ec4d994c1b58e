// Small scenes: some with a known picture, some with every material and light. All are path-traced with MIS unless a
// test says otherwise.
#pragma once

#include "support/plain_scenes.h"

namespace opal::test {

// A camera of width x height pixels at `from`, looking at `to` with that full horizontal angle, box filter.
Camera camera(Vec3 from, Vec3 to, int width, int height, double fov = 60);

// A closed cube whose walls have that albedo and emit that radiance, seen from inside. Radiance is the same L at every
// point in every direction, so L = emitted + albedo L: every pixel of every full path tracer has the mean emitted / (1
// - albedo).
SceneDescription furnace(double albedo, double emitted);

// The camera inside a tetrahedron of glass (index 1.5 in vacuum), within black walls that emit 1. The tetrahedron is
// irregular, so that no path is caught for ever. A reflection has weight 1, leaving the glass (n_inside / n_outside)^2:
// every sample is 1.5^2.
SceneDescription glass_furnace();

// triangle_light with the light's back to the floor.
SceneDescription averted_light();

// An octahedron with a normal at each vertex that points away from its middle, so that the interpolated one does so
// everywhere. The camera looks through a tiny angle at a point whose direction from the middle is smooth_normal().
SceneDescription smooth_octahedron();
Vec3 smooth_normal();

// A triangle that emits (3, 2, 1) above a diffuse floor of albedo 0.8, one bounce, in an empty world. The camera sees
// the floor through a tiny angle, so that all pixels have the radiance triangle_light_truth().
SceneDescription triangle_light();
// Lambert's formula (1760) for the irradiance from a uniform polygon: E = L/2 sum_i angle_i cos(n, normal of the plane
// through the point and edge i); the radiance that leaves is albedo / pi E. Red, with L = 3.
double triangle_light_truth();

// A point light of 100 W above a floor, seen as the triangle light's floor is, in red.
// A pane seen at right angles: reflected paths meet a light of radiance 1, refracted ones leave the scene.
SceneDescription reflection(float index);

SceneDescription point_light();
double point_light_truth(); // albedo / pi * power / (4 pi) * cos / d^2

// The furnace in a sphere.
SceneDescription round_furnace(double albedo, double emitted);

// A sphere of that radius above a floor, seen as the triangle light's floor is, at the middle of the scene, where
// floats are densest. The irradiance is pi L (radius / d)^2 cos, and red has the radiance sphere_light_truth().
SceneDescription sphere_light(double radius);
double sphere_light_truth();

// A closed room with each BSDF, each kind of area light (the mesh light's triangles differ 170-fold in area), shading
// normals: 45 triangles, so that 4 lanes and more do without a tree.
SceneDescription gallery(int width = 16, int height = 16);
// The same without specular surfaces and with black lights: what light there is comes in one bounce or more.
SceneDescription matte_gallery(int width = 16, int height = 16);

} // namespace opal::test
