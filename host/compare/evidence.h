// The evidence of a comparison of two images: maps of their differences, as images and files.
#pragma once

#include "image/image.h"
#include "stats/tiles.h"

#include <filesystem>

namespace opal {

// The layers R, G, B and variance.R, .G, .B as an estimate, which points into the image. dof: samples a pixel - 1, or
// batches - 1. Error that names a missing layer.
stats::Estimate estimate_of(const Image &image, double samples, double dof);

// Values as colours for write_png: 0 white, +limit and above red, -limit and below blue, not finite magenta.
Image false_colour(const std::vector<float> &values, int width, int height, double limit);

// The z or p of each tile spread over its pixels, layers R, G, B.
Image tile_map(const stats::TileTest &test, const std::vector<double> &values, int width, int height);

// image - reference, layers R, G, B.
Image difference(const Image &image, const Image &reference);
// The sum over R, G, B of such a difference, white to colour at the 99th percentile of its size (see false_colour).
Image difference_colours(const Image &difference);

// Writes image, reference, difference, z and p as .exr and .png into `folder`, which is made if it is missing. Both
// images' PNGs have one exposure (99 % of the reference's values lie below white). difference.png shows the sum over R,
// G and B, with full colour at the 99th percentile of its size; z.png the worst channel, with full colour at |z| = 5;
// p.png -log10 p, black at 6.
void write_evidence(const std::filesystem::path &folder, const Image &image, const Image &reference,
                    const stats::TileTest &test);

// One sentence: the p-value, the worst tile, the largest region. Channels by name.
std::string describe(const stats::TileTest &test);

} // namespace opal
