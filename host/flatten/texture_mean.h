// Textures by themselves, on the host: their values, and their means over the surfaces that they are on.
#pragma once

#include "base/color.h"
#include "scene/textures.h"
#include "shapes/list.h"

#include <cstddef>
#include <span>
#include <vector>

namespace opal {

// The texture's linear colour at these texture coordinates, as the device has it (cl/textures/NAME.cl). 0 of an
// attribute of meshes.
Color color_at(const Texture &texture, double u, double v);

// The mean over triangles of these texture coordinates, each weighted by its area: that of `lookups` values, and one
// more for each triangle. Each triangle has its share by area, at its centroid, or spread over it by the R2 sequence
// (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
Color mean_over_triangles(const Texture &texture, std::span<const TriangleUv> triangles,
                          const std::vector<double> &areas, std::size_t lookups);

// The mean over a sphere: of `lookups` values, spread over its area likewise.
Color mean_over_sphere(const Texture &texture, std::size_t lookups);

} // namespace opal
