// The tables of lights: what emits, and how it is chosen.
#pragma once

#include "flatten/geometry.h"

namespace opal {

// Fills scene.emitters, scene.light_triangles and MeshRecord::emitter. Needs scene.triangles, scene.meshes and
// scene.blocks. What emits nothing is no emitter. Areas are those of the triangles as rounded to float, summed in
// double.
void gather_emitters(const SceneDescription &description, const Frame &frame, const TriangleSoup &soup,
                     FlatScene &scene);

} // namespace opal
