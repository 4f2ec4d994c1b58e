// The 8-wide bounding volume hierarchy over triangles, and the blocks of eight triangles that are its leaves.
#pragma once

#include "shared/types.h"

#include <array>
#include <vector>

namespace opal {

// Triangles that share vertices, in the flattened scene's units. None of them is degenerate.
struct TriangleSoup {
    std::vector<std::array<float, 3>> vertices;
    std::vector<std::array<uint, 3>> corners; // index = id of the triangle
};

struct Bvh {
    std::vector<BvhNode> nodes;        // parents before their children; the first is the root, and always there
    std::vector<TriangleBlock> blocks; // never empty
};

// Cost of visiting a node and of testing a block, in the units of sah_cost.
constexpr double NODE_COST = 1, BLOCK_COST = 1;

// Binary tree by the surface area heuristic, improved by reinsertion, collapsed to 8 children by dynamic programming
// (Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3.2).
// Every triangle is in a block, or its parts are in several, where references_of says so; levels_of(bvh) <=
// OPAL_LEVELS. Without triangles: a root without children, one block of none.
Bvh build_bvh(const TriangleSoup &soup);

// Blocks in the order of the triangles, for scenes that need no tree; one empty block at least.
std::vector<TriangleBlock> pack_blocks(const TriangleSoup &soup);

// What a ray that meets the root's box is expected to cost (MacDonald and Booth 1990): the areas of the nodes and of
// the leaves over the root's area, times NODE_COST and BLOCK_COST.
double sah_cost(const Bvh &bvh);

// Nodes one below the other, root and all, where they are most.
int levels_of(const Bvh &bvh);

} // namespace opal
