// Wavefront OBJ: v, vt, vn and f, with polygons of any size. Our own reader, since tinyobjloader 2.0 rc10 reads "v nan"
// or "v 1 2 x" as 0 without a word and knows no line of a bad index.
#pragma once

#include "scene/scene.h"

namespace opal {

// Vertices and normals in world space. Triangles without area are dropped with a warning that counts them, and so is a
// mesh left with none. Throws Error "file:line: ..." for a bad number or index.
TriangleMesh read_obj(const std::filesystem::path &file, const Transform &to_world);

// Splits a polygon into triangles of corner numbers, by ear clipping (Meisters 1975) in the plane of its Newell normal;
// a convex one becomes the fan from its first corner, as Nori splits it. Always corners - 2 triangles.
std::vector<std::array<unsigned, 3>> triangulate(const std::vector<Vec3> &corners);

} // namespace opal
