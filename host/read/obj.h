// The reader of Wavefront OBJ files: tinyobjloader behind a strict pass over the text (read/obj_statements.h), with
// polygons of any size. host/README.md says why, and a test shows which of the library's habits remain.
#pragma once

#include "base/hash.h"
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

// Reads a mesh; vertices and normals of the result are in world space. Triangles without area are dropped. Numbers are
// rounded to double; those below its range are 0. Warns, with the place of the first and a count, of dropped triangles,
// of a file without triangles, of `vt` and `vn` that are not finite, and of indices of them that are 0 or past the end:
// corners that name these have none. Notes statements and numbers that it ignores. Throws Error "file:line:col: ..."
// for any other bad number or index, and for text that has no statement of an OBJ file.
ObjFile read_obj(const std::filesystem::path &file, const Transform &to_world, FileHashes *hashes = nullptr);

} // namespace opal
