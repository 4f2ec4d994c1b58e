// The reader of PLY files (Turk 1994), in text and both binary formats.
#pragma once

#include "base/hash.h"
#include "scene/shapes.h"

#include <filesystem>
#include <span>
#include <string>

namespace opal {

// Reads a mesh; vertices and normals of the result are in world space. Of `vertex` it takes x y z, nx ny nz, and uv as
// u v, s t or texture_u texture_v; of `face` vertex_indices or vertex_index; and of both the attributes that are asked
// for, under the names that Mitsuba gives them: vertex_color of red green blue or r g b; vertex_foo of foo_x foo_y
// foo_z, foo_0 ... or foo_1 ..., or the first of them alone; vertex_foo_color of foo_r foo_g foo_b; likewise face_... .
// Their numbers are taken as they stand, also whole ones, of which it warns; those that are not finite are 0. Elements
// may be in any order, and so may their properties; what else there is, is skipped with a note. Faces of more than
// three corners are triangulated, and triangles without area are dropped. Warns of these, of normals that are on the
// back of every face, and of normals and uv that are not finite: corners have none. Throws Error for anything else that
// is wrong: "file:line:col: ..." in the header and in text, "file: byte N (vertex 3): ..." in binary data, where
// elements count from 0 as indices do. Takes no more memory than in proportion to the file.
TriangleMesh read_ply(const std::filesystem::path &file, const Transform &to_world, FileHashes *hashes = nullptr,
                      std::span<const std::string> attributes = {});

} // namespace opal
