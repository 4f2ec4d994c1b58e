// The weights of pixel filters, as the device computes them (cl/film/filter.cl).
#pragma once

#include "scene/scene.h"

namespace opal {

std::string filter_text(const Filter &filter); // "gaussian, radius 2 pixels"

// The distance from a pixel's centre, in pixels, beyond which all weights are 0 in single precision: the radius, or
// less where a Gaussian has fallen to 0 before.
double filter_extent(const Filter &filter);

// What is wrong with a filter's weights in single precision, and what is possible; empty: nothing. The samples of a
// pixel must have weights above 0 in it, and all weights that a sample has must add up to more than 0. Else pixels
// would be black or NaN although their samples are not.
std::string filter_problem(const Filter &filter);

} // namespace opal
