#include "sweep/reference.h"

#include "base/color.h"
#include "image/metrics.h"
#include "plot/canvas.h"

#include <array>
#include <cmath>

namespace opal {

namespace {

constexpr std::array<const char *, 3> channels = {"R", "G", "B"};

std::vector<double> luminances(const Image &image) {
    std::vector<double> y(size_t(image.width) * size_t(image.height));
    for (size_t c = 0; c < 3; c++) {
        const std::vector<float> &values = image.get(channels[c]).values;
        for (size_t p = 0; p < y.size(); p++)
            y[p] += luminance_weights[c] * double(values[p]);
    }
    return y;
}

double mean_of(const std::vector<double> &values) {
    double sum = 0;
    for (double v : values)
        sum += v;
    return sum / double(values.size());
}

} // namespace

double mean_luminance(const Image &image) { return mean_of(luminances(image)); }

double mean_square(const Image &image) {
    double sum = 0;
    for (const char *channel : channels)
        for (float v : image.get(channel).values)
            sum += double(v) * double(v);
    return sum / (double(channels.size()) * image.width * image.height);
}

Image reference_from_halves(const Image &a, const Image &b) {
    Image reference{a.width, a.height, {}, {}};
    for (const char *channel : channels) {
        const std::vector<float> &va = a.get(channel).values, &vb = b.get(channel).values;
        Layer mean{channel, va}, variance{std::string("variance.") + channel, va};
        for (size_t p = 0; p < va.size(); p++) {
            const double x = double(va[p]), y = double(vb[p]);
            mean.values[p] = float((x + y) / 2);
            variance.values[p] = float((x - y) * (x - y) / 4);
        }
        reference.layers.push_back(std::move(mean));
        reference.layers.push_back(std::move(variance));
    }
    return reference;
}

ImageError error_against(const Image &reference, const Image &image) {
    const Metrics metrics = compare_images(image, reference);
    ImageError error{metrics.mse, metrics.rel_mse};
    double variance = 0, relative = 0, count = 0;
    for (const char *channel : channels) {
        const Layer *layer = reference.find(std::string("variance.") + channel);
        if (!layer)
            return error;
        const std::vector<float> &mean = reference.get(channel).values;
        for (size_t p = 0; p < mean.size(); p++) {
            const double v = double(layer->values[p]),
                         denominator = double(mean[p]) * double(mean[p]) + metrics.rel_mse_floor;
            variance += v;
            relative += denominator > 0 ? v / denominator : 0;
            count++;
        }
    }
    error.mse -= variance / count;
    error.rel_mse -= relative / count;
    return error;
}

Image error_map(const Image &reference, const Image &image) {
    const std::vector<double> r = luminances(reference), x = luminances(image);
    const double floor = 0.01 * mean_of(r);
    Canvas canvas(image.width, image.height, {0, 0, 0});
    for (size_t p = 0; p < r.size(); p++) {
        const double scale = std::abs(r[p]) + floor, error = scale > 0 ? std::abs(x[p] - r[p]) / scale : 0;
        canvas.fill(int(p % size_t(image.width)), int(p / size_t(image.width)), 1, 1,
                    viridis(std::sqrt(std::fmin(error, 1))));
    }
    return canvas.image();
}

} // namespace opal
