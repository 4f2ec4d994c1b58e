// What holds for every result of a reader and of flatten, whatever the input: the device relies on it unchecked.
#pragma once

#include "flatten/flat_scene.h"

namespace opal::fuzz {

// Of what a reader made: finite coordinates, unit normals, indices in range, a material for each run of triangles.
void check(const TriangleMesh &mesh);

// Every triangle is in a block and every index in range; each node and leaf is met once from the root, boxes of
// children lie in those of their parents, and the tree has at most OPAL_LEVELS levels; probabilities of each table sum
// to one. All coordinates are finite.
void check(const FlatScene &scene);

// A light whose radiance or intensity is not finite must be warned of.
bool has_finite_lights(const FlatScene &scene);

} // namespace opal::fuzz
