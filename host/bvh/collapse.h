// From the binary tree to the 8-wide one.
#pragma once

#include "bvh/binary_tree.h"

namespace opal {

constexpr int WIDTH = 8; // children of a node

// The 8-wide tree of least sah_cost that keeps the binary tree's cuts (Ylitie, Karras, Laine 2017, section 3.2). Where
// it would have more than OPAL_LEVELS levels, what lies below is cut in halves instead, which takes one for each factor
// of 8. May reorder tree.references.
Bvh collapse(BinaryTree &tree, const TriangleSoup &soup);

// A node without children.
BvhNode empty_node();

// The block of triangles ids[0 .. count-1], count <= BLOCK_SIZE. Unused places are the first triangle's first corner
// thrice.
TriangleBlock pack_block(const TriangleSoup &soup, const uint *ids, uint count);

} // namespace opal
