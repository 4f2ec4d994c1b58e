// A binary bounding volume hierarchy by the surface area heuristic: what the 8-wide tree is collapsed from.
#pragma once

#include "bvh/early_split.h"

#include <memory>
#include <span>

namespace opal {

constexpr uint BLOCK_SIZE = 8; // references of a leaf at most

struct BinaryNode {
    Box box;
    uint first, count; // its range of the references
    uint left;         // its right child is left + 1; 0: a leaf
};

struct BinaryTree {
    std::unique_ptr<BinaryNode[]> nodes; // root first, parents before their children
    uint node_count = 0;
    std::vector<Reference> references;
};

// Costs are counted in blocks: ceil(n / BLOCK_SIZE) times the area. Leaves hold 1 to BLOCK_SIZE references; smaller
// sets are split where that makes the areas of both parts together smaller. There is at least one reference.
BinaryTree build_binary_tree(std::vector<Reference> references);

// Orders the set into halves along the longest axis of its middles; returns the size of the first one, the larger by
// one.
std::size_t halve(std::span<Reference> set);

} // namespace opal
