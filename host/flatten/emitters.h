// The tables of emitters and the probabilities with which light sampling chooses them.
#pragma once

#include "flatten/geometry.h"
#include "flatten/textures.h"

namespace opal {

// Fills scene.emitters, scene.light_triangles, MeshRecord::emitter and the settings' emitter_count and environment;
// needs scene.triangles, scene.meshes and scene.triangle_blocks. A light that emits nothing is left out. Areas are in
// flattened units, those of the rounded triangles, summed in double. Meshes of triangles may be empty by now: radius is
// that of the scene's bounding sphere, in world units. Error: a second environment.
void gather_emitters(const SceneDescription &description, const Flattening &flattening, double radius,
                     const TriangleSoup &soup, TextureGatherer &textures, FlatScene &scene);

} // namespace opal
