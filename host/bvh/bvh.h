// The 8-wide bounding volume hierarchy over triangles, and the blocks of eight triangles that are its leaves.
#pragma once

#include "bvh/box.h"
#include "shared/types.h"

#include <vector>

namespace opal {

// An indexed triangle mesh in flattened units. No triangle is degenerate.
struct TriangleSoup {
    std::vector<Point3f> vertices;
    std::vector<std::array<uint, 3>> corners; // three vertex indices for each triangle id
};

struct Bvh {
    std::vector<BvhNode> nodes;        // the root first, parents before their children; never empty
    std::vector<TriangleBlock> blocks; // the leaves; never empty
};

// Costs in the surface area heuristic: a visit of a node and the test of a block.
constexpr double node_cost = 1, block_cost = 1;

// Builds the tree in three steps: a binary tree by the surface area heuristic, reinsertion, and the collapse to 8
// children by dynamic programming (Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through
// Compressed Wide BVHs", section 3.2). A triangle that split_primitives cuts may be in several blocks, every other one
// is in one block. levels_of(result) <= OPAL_LEVELS. An empty soup gives a root without children and one empty block.
Bvh build_bvh(const TriangleSoup &soup);

// Packs all triangles into blocks in the order of their ids, for scenes without a tree. An empty soup gives one empty
// block.
std::vector<TriangleBlock> pack_blocks(const TriangleSoup &soup);

// The expected cost of a ray that meets the root's box, by the surface area heuristic (MacDonald and Booth 1990): the
// sum of all boxes' areas, times node_cost or block_cost, divided by the root's area.
double sah_cost(const Bvh &bvh);

// The number of nodes on the longest path from the root, which counts as one.
int levels_of(const Bvh &bvh);

} // namespace opal
