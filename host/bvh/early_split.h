// What a tree is built over: boxes of triangles, or of parts of them.
#pragma once

#include "bvh/box.h"
#include "bvh/bvh.h"

namespace opal {

struct Reference {
    Box box;
    uint triangle;
};

// The box of every triangle.
std::vector<Reference> whole_triangles(const TriangleSoup &soup);

// The same where triangles fill their boxes. Where most of the boxes' area is empty, as where long triangles lie askew,
// those that waste the most have a box for each of several parts (Ernst and Greiner 2007, "Early Split Clipping for
// Bounding Volume Hierarchies"): every point of a triangle is in one of its boxes.
std::vector<Reference> references_of(const TriangleSoup &soup);

} // namespace opal
