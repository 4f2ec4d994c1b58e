// The scenes that the stress tests of `opal extremes` stretch. A room has half side 1.
#pragma once

#include "scene/examples.h"

namespace opal::extremes {

using namespace examples;

// A cube of half side 1 that faces inwards; each side is cut along both axes, 1 / aspect from the edge.
TriangleMesh slivered_cube(double aspect);
// The same cube with a small triangle in the middle of each triangle, of `area` times its area.
TriangleMesh cube_with_specks(double area);

// A scene for path tracing with MIS and at most `max_depth` segments.
SceneDescription path_traced(std::vector<Mesh> meshes, const Camera &camera, unsigned max_depth);

// A closed room with a light, a diffuse cube, a glass cube, a glossy floor and a glossy panel. No wall is parallel to
// an axis.
SceneDescription room();
// Ambient occlusion in the closed room: the walls block every ray, so that the mean luminance is the share of leaks.
SceneDescription closed_walls();
// Ambient occlusion of a plane that fills the view: nothing blocks a ray, so that 1 minus the mean luminance is the
// share of self-shadows.
SceneDescription open_plane();
// The same of spheres: a round room of balls, one of which is the light; a ball alone.
SceneDescription balls();
SceneDescription round_walls();
SceneDescription open_ball();
// The scene with ambient occlusion as its integrator.
SceneDescription occlusion_of(SceneDescription scene);

// The scene with its meshes, lights and camera transformed.
SceneDescription moved(SceneDescription scene, const Transform &by);
// The same by the map p * factor + offset.
SceneDescription moved(SceneDescription scene, double factor, Vec3 offset);

} // namespace opal::extremes
