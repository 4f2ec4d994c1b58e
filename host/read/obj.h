// The reader of Wavefront OBJ files: v, vt, vn and f, with polygons of any size. host/README.md says why it is not
// tinyobjloader, and a test holds it against tinyobjloader.
#pragma once

#include "scene/scene.h"

namespace opal {

// Reads a mesh; vertices and normals of the result are in world space. Triangles without area are dropped, with a
// warning that counts them. Throws Error "file:line:col: ..." for a bad number or index, "file: ..." for a mesh without
// triangles.
TriangleMesh read_obj(const std::filesystem::path &file, const Transform &to_world);

// Triangles of a polygon, as indices of corners, by ear clipping (Meisters 1975) in the plane of its Newell normal. A
// convex polygon becomes the fan around its first corner, as in Nori. Always gives corners - 2 triangles. Error: more
// than max_concave_corners, and not convex.
constexpr unsigned max_concave_corners = 10000;
std::vector<std::array<unsigned, 3>> triangulate(const std::vector<Vec3> &corners);

} // namespace opal
