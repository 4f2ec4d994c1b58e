#include "film/film.h"

#include "base/color.h"
#include "base/large_vector.h"

#include <cmath>

namespace opal {

namespace {

// The variance of the mean of n values with this sum and sum of squares. Rounding cannot make it negative.
double variance_of_mean(double sum, double squares, double n) {
    return n < 2 ? 0 : std::fmax(0, squares - sum * sum / n) / (n * (n - 1));
}

} // namespace

FilmStatistics statistics_of(const Film &film) {
    FilmStatistics s;
    double filled = 0, variance = 0;
    double single_sum = 0, single_squares = 0; // over pixels with a single sample
    for (size_t p = 0; p < film.sum.size(); p++) {
        const double n = film.count[p];
        if (n == 0) {
            s.empty_pixels++;
            continue;
        }
        s.samples += film.count[p];
        filled++;
        for (int c = 0; c < 3; c++)
            s.mean_rgb[c] += film.sum[p][c] / n;
        const double y = luminance(film.sum[p]);
        variance += variance_of_mean(y, film.squares[p][3], n);
        if (n == 1) {
            s.single_sample_pixels++;
            single_sum += y;
            single_squares += y * y;
        }
    }
    s.invalid = film.invalid;
    if (filled == 0)
        return s;
    for (double &c : s.mean_rgb)
        c /= filled;
    s.mean_luminance = luminance(s.mean_rgb);
    const double singles = double(s.single_sample_pixels);
    variance += singles * singles * variance_of_mean(single_sum, single_squares, singles);
    s.stderr_luminance = std::sqrt(variance) / filled;
    return s;
}

Image image_of(const Film &film, bool variance) {
    Image image;
    image.width = film.width;
    image.height = film.height;
    image.crop = film.crop;
    const size_t pixels = film.sum.size();
    const char *names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; c++) {
        Layer layer{names[c], std::vector<float>(pixels)};
        for (size_t p = 0; p < pixels; p++) {
            const double weight = film.weighted.empty() ? film.count[p] : film.weighted[p][3];
            const double sum = film.weighted.empty() ? film.sum[p][c] : film.weighted[p][c];
            layer.values[p] = weight != 0 ? float(sum / weight) : 0.f;
        }
        image.layers.push_back(std::move(layer));
    }
    for (int c = 0; variance && c < 3; c++) {
        Layer layer{std::string("variance.") + names[c], std::vector<float>(pixels)};
        for (size_t p = 0; p < pixels; p++)
            layer.values[p] = float(variance_of_mean(film.sum[p][c], film.squares[p][c], film.count[p]));
        image.layers.push_back(std::move(layer));
    }
    return image;
}

Image take_image(Film &film, bool variance) {
    Image image = image_of(film, variance);
    free_memory(film.sum);
    free_memory(film.squares);
    free_memory(film.weighted);
    free_memory(film.count);
    return image;
}

} // namespace opal
