// The picture of a density test: the samples, the stated density, and their difference.
#pragma once

#include "densities/sampled.h"
#include "plot/canvas.h"

namespace opal {

// Three panels over the grid of the test: density of the samples, mean density of the pdf (both in one scale, 1 /
// measure), and (observed - expected) / sqrt(expected) from -4 to 4.
Image plot_density(const Sampled &sampled, const DensityCheck &check, const std::string &title);

} // namespace opal
