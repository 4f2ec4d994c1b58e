// Scenes that the sweeps of `opal extremes` stretch. All in memory, in plain units: a room has half side 1.
#pragma once

#include "scene/examples.h"

namespace opal::extremes {

using namespace examples;

// A cube of half side 1 that faces inwards, each side cut twice across, 1 / aspect from the edge.
TriangleMesh slivered_cube(double aspect);
// The same cube; in the middle of each triangle lies one of `area` times its area.
TriangleMesh cube_with_specks(double area);

// Path tracing with MIS and at most `max_depth` segments.
SceneDescription path_traced(std::vector<Mesh> meshes, const Camera &camera, unsigned max_depth);

// A closed room, no wall of which is parallel to an axis, with a light, a diffuse cube, a glossy floor and a pane of
// glass.
SceneDescription room();
// Ambient occlusion within closed walls: every way out is blocked, so that all light is a leak.
SceneDescription closed_walls();
// Ambient occlusion of a plane that fills the view: nothing blocks anything, so that what is missing from 1 shadows
// itself.
SceneDescription open_plane();
// Ambient occlusion instead of the scene's strategy.
SceneDescription occlusion_of(SceneDescription scene);

// The scene with every point moved, the camera too.
SceneDescription moved(SceneDescription scene, const Transform &by);
// The same by p * factor + offset.
SceneDescription moved(SceneDescription scene, double factor, Vec3 offset);

} // namespace opal::extremes
