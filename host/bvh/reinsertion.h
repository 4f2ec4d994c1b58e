// Optimisation of a binary tree by reinsertion: subtrees move to where the sum of all boxes' areas is smaller.
#pragma once

#include "bvh/binary_tree.h"

namespace opal {

// Moves the subtrees of largest area, one after the other, to the place where the sum of all areas falls most (Bittner,
// Hapala, Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies"; the search is that of
// Meister and Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization"). Leaves keep their
// primitives. Afterwards parents may come after their children, and `first` holds for leaves alone.
void optimise_by_reinsertion(BinaryTree &tree);

} // namespace opal
