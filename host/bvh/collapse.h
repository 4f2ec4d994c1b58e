// The collapse of a binary tree to an 8-wide one.
#pragma once

#include "bvh/binary_tree.h"

namespace opal {

constexpr int node_width = 8; // children of a BvhNode

// Returns the 8-wide tree of least sah_cost among those that merge nodes of the binary tree (Ylitie, Karras, Laine
// 2017, section 3.2). A subtree that would go below OPAL_LEVELS levels is replaced by a balanced one, whose depth is
// logarithmic to base 8 in the number of blocks. May reorder tree.primitives.
Bvh collapse(BinaryTree &tree, const TriangleSoup &soup);

// A node without children: their boxes are empty.
BvhNode empty_node();

// The block of triangles ids[0 .. count-1], count <= block_size. An unused place holds a degenerate triangle, the first
// corner of the first triangle thrice, which no ray hits.
TriangleBlock pack_block(const TriangleSoup &soup, const uint *ids, uint count);

} // namespace opal
