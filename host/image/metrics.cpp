#include "image/metrics.h"

#include "base/error.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace opal {

namespace {

using Pixel = std::array<double, 3>;

class Pixels {
public:
    explicit Pixels(const Image &image) : channels_{&image.get("R"), &image.get("G"), &image.get("B")} {}
    Pixel operator[](size_t i) const {
        return {channels_[0]->values[i], channels_[1]->values[i], channels_[2]->values[i]};
    }
    size_t size() const { return channels_[0]->values.size(); }

private:
    std::array<const Layer *, 3> channels_;
};

bool is_finite(const Pixel &p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); }

double mean_of(const Pixels &pixels) {
    double sum = 0;
    size_t count = 0;
    for (size_t i = 0; i < pixels.size(); ++i)
        if (const Pixel p = pixels[i]; is_finite(p)) {
            sum += p[0] + p[1] + p[2];
            count += 3;
        }
    return count ? sum / static_cast<double>(count) : 0;
}

double square(double x) { return x * x; }
double ratio(double a, double b) { return b > 0 ? a / b : 0; }

} // namespace

InvalidPixels invalid_pixels(const Image &image) {
    const Pixels values(image);
    InvalidPixels invalid;
    for (size_t i = 0; i < values.size(); ++i)
        if (!is_finite(values[i]) && invalid.count++ == 0) {
            invalid.x = static_cast<int>(i % size_t(image.width));
            invalid.y = static_cast<int>(i / size_t(image.width));
        }
    return invalid;
}

Metrics compare_images(const Image &image, const Image &reference) {
    if (image.width != reference.width || image.height != reference.height)
        throw Error(fmt::format("images of different sizes cannot be compared: {} x {} and {} x {} pixels", image.width,
                                image.height, reference.width, reference.height));
    const Pixels values(image), references(reference);
    Metrics m;
    m.rel_mse_floor = square(0.01 * mean_of(references));
    double mapped = 0;
    size_t count = 0;
    for (size_t i = 0; i < values.size(); ++i) {
        const Pixel a = values[i], b = references[i];
        if (!is_finite(a) || !is_finite(b)) {
            ++m.invalid;
            continue;
        }
        for (size_t c = 0; c < 3; ++c, ++count) {
            const double d = a[c] - b[c];
            m.mse += d * d;
            m.rel_mse += ratio(d * d, b[c] * b[c] + m.rel_mse_floor);
            m.mae += std::abs(d);
            m.smape += ratio(2 * std::abs(d), std::abs(a[c]) + std::abs(b[c]));
            m.mean_difference += d;
            mapped += square(srgb_encode(a[c]) - srgb_encode(b[c]));
            if (std::abs(d) > m.max_difference) {
                m.max_difference = std::abs(d);
                m.max_x = static_cast<int>(i % size_t(image.width));
                m.max_y = static_cast<int>(i / size_t(image.width));
            }
        }
    }
    if (count == 0)
        throw Error("images without a finite pixel in common cannot be compared");
    const double n = static_cast<double>(count);
    for (double *sum : {&m.mse, &m.rel_mse, &m.mae, &m.smape, &m.mean_difference, &mapped})
        *sum /= n;
    m.rmse = std::sqrt(m.mse);
    m.psnr = mapped > 0 ? -10 * std::log10(mapped) : std::numeric_limits<double>::infinity();
    return m;
}

} // namespace opal
