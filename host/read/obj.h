// Wavefront OBJ: v, vt, vn and f, with polygons of any size. Our own reader, held against tinyobjloader by a test;
// README's design says why.
#pragma once

#include "scene/scene.h"

namespace opal {

// Vertices and normals in world space. Triangles without area are dropped with a warning that counts them. Throws Error
// "file:line:col: ..." for a bad number or index, "file: ..." for a mesh left with no triangle.
TriangleMesh read_obj(const std::filesystem::path &file, const Transform &to_world);

// Splits a polygon into triangles of corner numbers, by ear clipping (Meisters 1975) in the plane of its Newell normal;
// a convex one becomes the fan from its first corner, as Nori splits it. Always corners - 2 triangles.
std::vector<std::array<unsigned, 3>> triangulate(const std::vector<Vec3> &corners);

} // namespace opal
