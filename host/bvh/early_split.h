// The boxes that a tree is built over: one for each primitive, or several for the parts of a long triangle.
#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"

namespace opal {

struct BuildPrimitive {
    Box box; // of the primitive, or of a part of it
    uint id; // of the primitive
};

// One for each triangle, in the order of the ids, then one for each primitive of other shapes. left_out: ids of
// triangles without one, in ascending order.
LargeVector<BuildPrimitive> whole_primitives(const TriangleSoup &soup, std::span<const uint> left_out = {});

// Early split clipping (Ernst and Greiner 2007, "Early Split Clipping for Bounding Volume Hierarchies"): several
// primitives for each triangle whose box is mostly empty, such as a long one at an angle to the axes. Every point of a
// triangle is in one of its boxes. Where most boxes are well filled, the result is that of whole_primitives.
LargeVector<BuildPrimitive> split_primitives(const TriangleSoup &soup, std::span<const uint> left_out = {});

} // namespace opal
