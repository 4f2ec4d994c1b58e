// The triangles that are kept outside the tree: where a ray is likely to meet a triangle's box anyway, testing it against
// all lanes at once is cheaper than a leaf for each lane, and the tree that is left is smaller.
#pragma once

#include "flatten/bvh.h"
#include "flatten/flat_scene.h"

namespace opal {

// Ids of the triangles to list: all of a scene that is small enough, else the largest, whose boxes have at least
// LISTED_SHARE of the surface of the scene's box. At most OPAL_TINY_TRIANGLES, with OPAL_TINY_VERTICES distinct vertices.
std::vector<uint> choose_listed(const TriangleSoup &soup);
constexpr double LISTED_SHARE = 0.05;

// The tree over the triangles that are not listed.
void plant_tree(const TriangleSoup &soup, const std::vector<uint> &listed, FlatScene &scene);

// Blocks, distinct vertices and corners of the listed triangles.
void list_triangles(const TriangleSoup &soup, const std::vector<uint> &listed, FlatScene &scene);

} // namespace opal
