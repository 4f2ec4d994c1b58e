// The reader of Wavefront OBJ files: v, vt, vn and f, with polygons of any size. host/README.md says why it is not
// tinyobjloader, and a test holds it against tinyobjloader.
#pragma once

#include "scene/place.h"
#include "scene/shapes.h"
#include "shared/types.h"

#include <filesystem>

namespace opal {

// A material by the name that `usemtl` gives it: the rest of the line, without blanks at its ends.
struct ObjMaterial {
    std::string name;
    SourcePlace place; // of the first `usemtl` with this name
};

// What follows `mtllib`: a file's name, which may hold blanks, or several names.
struct ObjLibrary {
    std::string names; // the rest of the line, without blanks at its ends
    SourcePlace place;
};

// Triangles that follow each other and have the same material: from `first` to the next run's first.
struct ObjMaterialRun {
    size_t first;
    unsigned material; // index of ObjFile::materials; OPAL_NONE for faces before the first `usemtl`
};

// What an OBJ file holds. Materials are kept as runs, not as one index a triangle: a large file has few.
struct ObjFile {
    TriangleMesh mesh;
    std::vector<ObjMaterial> materials;        // in the order of their first use
    std::vector<ObjMaterialRun> material_runs; // cover all triangles, in order; empty in a file without `usemtl`
    std::vector<ObjLibrary> libraries;         // in the order of the file
};

// Reads a mesh; vertices and normals of the result are in world space. Triangles without area are dropped, with a
// warning that counts them. Throws Error "file:line:col: ..." for a bad number or index, "file: ..." for a mesh without
// triangles.
ObjFile read_obj(const std::filesystem::path &file, const Transform &to_world);

// Triangles of a polygon, as indices of corners, by ear clipping (Meisters 1975) in the plane of its Newell normal. A
// convex polygon becomes the fan around its first corner, as in Nori. Always gives corners - 2 triangles. Error: more
// than max_concave_corners, and not convex.
constexpr unsigned max_concave_corners = 10000;
std::vector<std::array<unsigned, 3>> triangulate(const std::vector<Vec3> &corners);

} // namespace opal
