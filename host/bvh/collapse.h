// The collapse of a binary tree to an 8-wide one.
#pragma once

#include "bvh/binary_tree.h"

namespace opal {

constexpr int node_width = 8; // children of a BvhNode

// Returns the 8-wide tree of least sah_cost among those that merge nodes of the binary tree (Ylitie, Karras, Laine
// 2017, section 3.2). A subtree that would go below OPAL_LEVELS levels is replaced by a balanced one, whose depth is
// logarithmic to base 8 in the number of blocks. has_others: there are primitives of other shapes than triangles.
Bvh collapse(const BinaryTree &tree, bool has_others);

// A node without children: their boxes are empty.
BvhNode empty_node();

} // namespace opal
