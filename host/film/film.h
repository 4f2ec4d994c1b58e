// What a render has gathered: sums over the finished samples of each pixel, and what follows from them.
#pragma once

#include "image/image.h"

#include <array>
#include <vector>

namespace opal {

struct InvalidSample {
    unsigned x, y, sample;
}; // was NaN or infinite

// Sums in double, as read back from the device's pairs of floats (cl/film/film.cl). Pixels row by row, top first.
struct Film {
    int width = 0, height = 0;
    std::vector<std::array<double, 3>> sum;      // of R, G, B
    std::vector<std::array<double, 4>> squares;  // of R^2, G^2, B^2, luminance^2
    std::vector<std::array<double, 4>> weighted; // of w R, w G, w B, w; empty for the box filter
    std::vector<unsigned> count;                 // valid samples
    unsigned long long invalid = 0;              // samples left out because they were not finite
    std::vector<InvalidSample> invalid_places;   // of the first few
};

// A mean over the image with its standard error, from the variances of the pixels (each pixel is a stratum: the error
// is of the image's noise, not of its content). A pixel with one sample has no variance within: that between all such
// pixels is taken for it, an upper bound. Stratified and Sobol samples: an upper bound too.
struct FilmStatistics {
    std::array<double, 3> mean_rgb{};
    double mean_luminance = 0, stderr_luminance = 0;
    unsigned long long samples = 0, invalid = 0;
    unsigned long long empty_pixels = 0; // without a valid sample: mean and error are of the others, not of the image
    unsigned long long single_sample_pixels = 0;
};
FilmStatistics statistics_of(const Film &film);

// Layers R, G, B; with `variance` also variance.R, .G, .B: the variance of each pixel's mean.
Image image_of(const Film &film, bool variance);

} // namespace opal
