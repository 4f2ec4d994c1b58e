// The reader of PLY files (Turk 1994), in text and both binary formats.
#pragma once

#include "base/hash.h"
#include "scene/shapes.h"

#include <filesystem>

namespace opal {

// Reads a mesh; vertices and normals of the result are in world space. Of `vertex` it takes x y z, nx ny nz, and uv as
// u v, s t or texture_u texture_v; of `face` vertex_indices or vertex_index. Elements may be in any order, and so may
// their properties; what else there is, is skipped with a note. Faces of more than three corners are triangulated, and
// triangles without area are dropped. Warns of these, of normals that are on the back of every face, and of normals and
// uv that are not finite: corners have none. Throws Error for anything else that is wrong: "file:line:col: ..." in the
// header and in text, "file: byte N (vertex 3): ..." in binary data, where elements count from 0 as indices do. Takes
// no more memory than in proportion to the file.
TriangleMesh read_ply(const std::filesystem::path &file, const Transform &to_world, FileHashes *hashes = nullptr);

} // namespace opal
