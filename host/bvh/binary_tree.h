// A binary bounding volume hierarchy by the surface area heuristic. The 8-wide tree is collapsed from it.
#pragma once

#include "bvh/early_split.h"

#include <memory>
#include <span>

namespace opal {

constexpr uint block_size = OPAL_WIDTH; // the most primitives of a leaf

struct BinaryNode {
    Box box;
    uint first, count; // the node's range of BinaryTree::primitives
    uint left;         // index of the left child; the right one is left + 1; 0: a leaf
};

struct BinaryTree {
    std::unique_ptr<BinaryNode[]> nodes; // the root first, parents before their children
    uint node_count = 0;
    LargeVector<BuildPrimitive> primitives; // each node's are contiguous
};

// Builds the tree top down. The cost of n primitives in a box is ceil(n / block_size) times its area, the cost of the
// blocks that they will fill. Leaves hold 1 to block_size primitives of one shape; a set that fits a leaf is still
// split where both parts together have less area. `primitives` must not be empty.
BinaryTree build_binary_tree(LargeVector<BuildPrimitive> primitives);

using PrimitiveSpan = std::span<BuildPrimitive>;

// Partitions the set at the median of its centres along their longest axis. Returns the size of the first half, which
// is the larger one where the count is odd.
std::size_t halve_at_median(PrimitiveSpan set);

} // namespace opal
