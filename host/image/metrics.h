// How far an image is from a reference, over the values of R, G and B.
#pragma once

#include "image/image.h"

namespace opal {

// Means are over all pixels and channels; d = image - reference.
struct Metrics {
    double mse = 0;             // mean d^2
    double rmse = 0;            // sqrt(mse)
    double rel_mse = 0;         // mean d^2 / (reference^2 + rel_mse_floor)
    double rel_mse_floor = 0;   // (1 % of the reference's mean)^2: black pixels count, in the image's own scale
    double mae = 0;             // mean |d|
    double smape = 0;           // mean |d| / ((|image| + |reference|) / 2), 0 where both are 0; 0 to 2
    double psnr = 0;            // dB, of the sRGB-encoded and clamped images, peak 1; infinite where they are equal
    double mean_difference = 0; // mean d
    double max_difference = 0;  // largest |d| ...
    int max_x = 0, max_y = 0;   // ... and its pixel
    size_t invalid = 0;         // pixels where either is not finite: left out of all the above
};

// Pixels whose R, G or B is NaN or infinite: how many, and the first.
struct InvalidPixels {
    size_t count = 0;
    int x = 0, y = 0;
};
InvalidPixels invalid_pixels(const Image &image);

// Throws Error where the sizes differ or a layer R, G or B is missing.
Metrics compare_images(const Image &image, const Image &reference);

} // namespace opal
