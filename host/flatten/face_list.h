// The triangles that are kept outside the tree: where a ray is likely to meet a triangle's box anyway, testing it
// against all lanes at once is cheaper than a leaf for each lane, and the tree that is left is smaller.
#pragma once

#include "bvh/bvh.h"
#include "flatten/flat_scene.h"

namespace opal {

// Ids of the triangles to list: all of a scene that is small enough, else the largest, whose boxes have at least
// FACE_LIST_SHARE of the surface of the scene's box. Two faces are tested side by side in the time of one: the first
// FIRST_TRIANGLES triangles, as many as two quadrilaterals have, need FIRST_SHARE only. At most
// OPAL_FACE_LIST_TRIANGLES, with OPAL_FACE_LIST_VERTICES distinct vertices.
std::vector<uint> choose_face_list(const TriangleSoup &soup);
constexpr double FACE_LIST_SHARE = 0.05, FIRST_SHARE = 0.01;
constexpr std::size_t FIRST_TRIANGLES = 4;

// A triangle A B C and, where both make a convex quadrilateral A B D C, a second one D C B: their ids, OPAL_NONE for no
// second one.
struct Face {
    uint first, second;
};

// Pairs the triangles `ids` into quadrilaterals where possible. Rotates the corners of each pair, in `soup` and in the
// scene's tables, so that they begin at A and at D.
std::vector<Face> pair_up(const std::vector<uint> &ids, TriangleSoup &soup, FlatScene &scene);

// Builds the tree over the primitives that are in no face of `faces`: fills scene.nodes, scene.sah_cost and the shapes'
// blocks. Where all are in faces, the tree is a root without children, and there are no blocks.
void build_tree(const TriangleSoup &soup, const std::vector<Face> &faces, FlatScene &scene);

// Appends the blocks of the face list to scene.triangle_blocks and fills their tables. Faces that no ray from a point
// of the scene to a point of `lights` or of their convex hull can cross come last: the whole scene is on one side of
// their plane, or all lights are in it. Where `lights` is nothing, light comes from outside the scene, and there are
// none.
void list_faces(const TriangleSoup &soup, std::vector<Face> faces, const std::optional<std::vector<Point3f>> &lights,
                FlatScene &scene);

} // namespace opal
