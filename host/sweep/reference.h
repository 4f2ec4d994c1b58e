// What images are held against, and how far from it they are.
#pragma once

#include "image/image.h"

namespace opal {

// R, G, B and, where known, the variance of each value as layers variance.R, .G, .B.
// From two images of disjoint samples (half the samples each): their mean, and (a - b)^2 / 4, an unbiased estimate of
// the variance of that mean whatever the filter.
Image reference_of(const Image &a, const Image &b);

struct ErrorAgainst {
    double mse = 0;     // mean of (image - reference)^2 - variance of the reference, over pixels and channels
    double rel_mse = 0; // each term divided by reference^2 + (1 % of the reference's mean)^2, as in image/metrics.h
};
// Unbiased where image and reference are independent: E[(X - R)^2] = E[(X - truth)^2] + Var[R].
// Throws Error where the sizes differ.
ErrorAgainst error_against(const Image &reference, const Image &image);

// |luminance - reference's| / (reference's + 1 % of its mean) in false colour; 1 and above is the brightest.
Image error_map(const Image &reference, const Image &image);

double mean_luminance(const Image &image);
double mean_square(const Image &image); // over pixels and R, G, B

} // namespace opal
