// What Mitsuba 3.9.1 makes of files of meshes, and its shapes `rectangle` and `cube`. All was measured there
// (tests/host/ply.cpp).
#pragma once

#include "scene/shapes.h"

namespace opal::mitsuba {

// Properties of the shapes `obj` and `ply`; flip_tex_coords is true by default of `obj`, false of `ply`.
struct MeshOptions {
    bool face_normals = false;    // flat: the file's normals are dropped
    bool flip_normals = false;    // normals of faces and of corners are turned round
    bool flip_tex_coords = false; // v becomes 1 - v
};

// The mesh of such a shape, from what read_obj or read_ply gives. A mesh without any normal gets smooth ones: those of
// the faces at a vertex, weighted by their angles there; smoothing stops where uv differ.
TriangleMesh finished_mesh(TriangleMesh read, const MeshOptions &options);

// The square [-1, 1]^2 of the plane z = 0. Its front is where its shading normal points there: to_world's image of +z,
// also if it mirrors. Throws Error without a place: to_world leaves it no area.
Parallelogram rectangle(const Transform &to_world, bool flip_normals);

// The cube [-1, 1]^3 with 24 vertices and uv from 0 to 1 on each side; its front is outside, also if to_world mirrors.
// Throws Error without a place: to_world leaves a side no area.
TriangleMesh cube(const Transform &to_world, bool flip_normals);

} // namespace opal::mitsuba
