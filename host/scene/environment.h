// An environment's radiance in all directions, as an image.
#pragma once

#include "base/math.h"
#include "scene/textures.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace opal {

// Linear RGB, W / (m^2 sr), interpolated bilinearly. Of a direction d in the map's own frame, u = atan2(d.x, -d.z) / 2
// pi and v = acos(d.y) / pi: column x is at u = (x + 1/2) / width, modulo 1, row y at v = y / (height - 1).
struct EnvironmentMap {
    int width = 0, height = 0; // at least 1 and 3
    LargeVector<float> texels; // R, G, B, rows from the top, finite and not negative
    double mean_luminance = 0; // over all directions

    float luminance_at(std::size_t texel) const;
};

// Decodes a picture. Rows are added between those of one that has fewer than three, so that the interpolated values
// stay. A value that is negative, infinite or no number becomes 0; a warning that names the file counts them. Error: it
// has more than 2^28 pixels.
std::shared_ptr<const EnvironmentMap> environment_of(Picture picture, const std::filesystem::path &file);

// The nearest matrix without lengths: columns that are unit and perpendicular, of which y keeps its direction. It
// mirrors where the transform does. No translation.
Transform orthonormal(const Transform &transform);

} // namespace opal
