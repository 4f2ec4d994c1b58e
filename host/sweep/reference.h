// The reference image of a sweep, and the errors of images against it.
#pragma once

#include "image/image.h"

namespace opal {

// Makes a reference of two images with half of the samples each: layers R, G, B hold the mean, layers variance.R, .G,
// .B its variance, for which (a - b)^2 / 4 is an unbiased estimate with any pixel filter.
Image reference_from_halves(const Image &a, const Image &b);

struct ImageError {
    double mse = 0;     // mean over pixels and channels of (image - reference)^2 - variance of the reference
    double rel_mse = 0; // the same with each term over reference^2 + (1 % of the reference's mean)^2 (image/metrics.h)
};
// The errors against a reference, whose variance is subtracted if its layers hold it. They are unbiased if image and
// reference are independent: E[(X - R)^2] = E[(X - truth)^2] + Var[R]. Throws Error if the sizes differ.
ImageError error_against(const Image &reference, const Image &image);

// The relative error of luminance in false colour: |luminance - reference| / (reference + 1 % of its mean). The
// brightest colour stands for 1 and above.
Image error_map(const Image &reference, const Image &image);

double mean_luminance(const Image &image);
double mean_square(const Image &image); // over pixels and R, G, B

} // namespace opal
