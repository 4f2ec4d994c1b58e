// The 8-wide bounding volume hierarchy over triangles and primitives of other shapes, and the blocks of up to eight of
// them that are its leaves.
#pragma once

#include "base/large_vector.h"
#include "bvh/box.h"
#include "shapes/list.h"
#include "shared/types.h"

#include <span>
#include <vector>

namespace opal {

// An id tells all primitives of a scene apart: shape << OPAL_SHAPE_SHIFT | index among those of its shape. So a
// triangle's id is its index.
inline uint shape_of(uint id) { return id >> OPAL_SHAPE_SHIFT; }

// A primitive of another shape than triangles. The tree knows its box alone.
struct BoundedPrimitive {
    uint id;
    Box box;
    uint mesh; // index
};

struct MeshAttribute;

// Where the numbers of a mesh attribute are among the scene's: those of triangle `triangle` + i, `stride` many, begin
// at `first` + i stride. Of an attribute of vertices they are those of three corners.
struct AttributeRange {
    const MeshAttribute *attribute;
    uint triangle, triangles = 0;
    std::size_t first;
    uint stride;
};

// The primitives of a scene in flattened units: an indexed triangle mesh, no triangle of which is degenerate, and
// primitives of other shapes.
struct TriangleSoup {
    LargeVector<Point3f> vertices;
    LargeVector<std::array<uint, 3>> corners = {}; // three vertex indices for each triangle id
    std::vector<BoundedPrimitive> others = {};
    std::vector<AttributeRange> attributes = {};
};

using BlockIds = std::array<uint, OPAL_WIDTH>; // ids of a block's primitives; OPAL_NONE in unused places, the last ones

struct Bvh {
    LargeVector<BvhNode> nodes; // the root first, parents before their children; never empty
    std::array<LargeVector<BlockIds>, OPAL_SHAPE_BITS> leaves = {}; // by shape; each will be a block of that shape
};

// Costs in the surface area heuristic: a visit of a node and the test of a block.
constexpr double node_cost = 1, block_cost = 1;

// Builds the tree in three steps: a binary tree by the surface area heuristic, reinsertion, and the collapse to 8
// children by dynamic programming (Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through
// Compressed Wide BVHs", section 3.2). A triangle that split_primitives cuts may be in several blocks, every other one
// is in one block. No leaf mixes shapes. levels_of(result) <= OPAL_LEVELS. left_out: ids of triangles that are not in
// the tree, in ascending order. A tree over nothing is a root without children and one empty block.
Bvh build_bvh(const TriangleSoup &soup, std::span<const uint> left_out = {});

// The block of some triangles. An unused place holds a degenerate triangle, the first corner of the first triangle
// thrice, which no ray hits.
TriangleBlock pack_block(const TriangleSoup &soup, const BlockIds &ids);

// The expected cost of a ray that meets the root's box, by the surface area heuristic (MacDonald and Booth 1990): the
// sum of all boxes' areas, times node_cost or block_cost, divided by the root's area.
double sah_cost(const Bvh &bvh);

// The number of nodes on the longest path from the root, which counts as one.
int levels_of(const Bvh &bvh);

} // namespace opal
