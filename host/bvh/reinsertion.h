// Makes a good binary tree better by moving subtrees to where they cost less.
#pragma once

#include "bvh/binary_tree.h"

namespace opal {

// Takes the subtrees of largest area in turn, looks for the place where the sum of all areas falls most, and moves them
// there (Bittner, Hapala, Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies"; the search
// is that of Meister and Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization"). Leaves stay
// as they are.
void optimise_by_reinsertion(BinaryTree &tree);

} // namespace opal
