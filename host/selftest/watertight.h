// Closed surfaces, and rays aimed at their edges and vertices: none may find a way out.
#pragma once

#include "probe/kernel_probe.h"

#include <random>

namespace opal::edges {

SceneDescription scene_of(const std::vector<Vec3> &positions, const std::vector<std::array<unsigned, 3>> &triangles);

// A sphere of rows x 2 rows quadrilaterals, two triangles each; rows = 3 has few enough triangles for no tree.
SceneDescription closed_sphere(unsigned rows);

// The triangles of a flat scene, as the device has them, and their slots.
using Corners = std::array<Vec3, 3>;
std::vector<Corners> corners_of(const FlatScene &scene, std::vector<uint> &slots);

void set_ray(Planes &rays, size_t i, Vec3 o, Vec3 d, double tmax);

// `count` rays from inside a closed surface that is star-shaped around the origin, aimed at its vertices and at points
// of its edges: how many of them meet nothing, be it as closest or as any hit?
unsigned long long lost_rays(KernelProbe &probe, size_t count, std::mt19937 &random);

} // namespace opal::edges
