// Closed surfaces, and rays aimed at their edges and vertices: none may find a way out.
#pragma once

#include "selftest/brute_force.h"

#include <random>

namespace opal::edges {

// The unit sphere in rows x columns quadrilaterals of two triangles each, columns = 2 rows where it is 0. rows = 3 has
// few enough triangles for no tree.
TriangleMesh closed_sphere(unsigned rows, unsigned columns = 0);

// `count` rays from inside a closed surface that is star-shaped around the origin, aimed at its vertices and at points
// of its edges: how many are lost (lost_among)?
size_t lost_rays(KernelProbe &probe, size_t count, std::mt19937 &random);

} // namespace opal::edges
