// The film: sums over the samples of each pixel, and the statistics and images that are computed from them.
#pragma once

#include "image/image.h"

#include <array>
#include <vector>

namespace opal {

// A sample that was NaN or infinite: its pixel in the whole image, and its index.
struct InvalidSample {
    unsigned x, y, sample;
};

// Sums of radiances, which the device keeps as pairs of floats. Pixels are in rows from the top left.
struct Film {
    int width = 0, height = 0;
    std::vector<std::array<double, 3>> sum;      // of R, G, B
    std::vector<std::array<double, 4>> squares;  // of R^2, G^2, B^2, luminance^2
    std::vector<std::array<double, 4>> weighted; // of w R, w G, w B, w; empty for the box filter
    std::vector<unsigned> count;                 // of valid samples
    unsigned long long invalid = 0;              // samples left out as NaN or infinite, those around a crop included
    std::vector<InvalidSample> invalid_places;   // the first few of them
    Crop crop{};                                 // the part of the image; all 0: the whole

    static constexpr size_t bytes_a_pixel(bool wide_filter) {
        return sizeof(double) * (3 + 4 + (wide_filter ? 4 : 0)) + sizeof(unsigned);
    }
};

// The image's mean and its standard error. Each pixel is a stratum, so that the error measures noise, not content: it
// combines the variances within the pixels. For pixels with a single sample the variance between all such pixels stands
// in, an upper bound. For stratified and Sobol samples the error is an upper bound, too.
struct FilmStatistics {
    std::array<double, 3> mean_rgb{};
    double mean_luminance = 0, stderr_luminance = 0;
    unsigned long long samples = 0, invalid = 0;
    unsigned long long empty_pixels = 0; // pixels without a valid sample, which mean and error leave out
    unsigned long long single_sample_pixels = 0;
};
FilmStatistics statistics_of(const Film &film);

// The image with layers R, G, B (radiance) and, with `variance`, variance.R, .G, .B: the variance of each pixel's mean.
// Pixels without samples are 0.
Image image_of(const Film &film, bool variance);
Image take_image(Film &film, bool variance); // the same; the film's sums, five times as large, are freed

} // namespace opal
