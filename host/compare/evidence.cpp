#include "compare/evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal {
namespace {

constexpr const char *channels[] = {"R", "G", "B"};

// The quantile q of the finite values; 0 if there are none.
double quantile(std::vector<float> values, double q) {
    std::erase_if(values, [](float v) { return !std::isfinite(v); });
    if (values.empty())
        return 0;
    auto at = values.begin() + std::ptrdiff_t(q * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// A layer made of R, G, B of each pixel.
template <class F> std::vector<float> per_pixel(const Image &image, F f) {
    const auto &r = image.get("R").values, &g = image.get("G").values, &b = image.get("B").values;
    std::vector<float> values(r.size());
    for (size_t i = 0; i < r.size(); ++i)
        values[i] = f(r[i], g[i], b[i]);
    return values;
}

Image scaled(const Image &image, double factor) {
    Image result{image.width, image.height, {}, {}};
    for (const char *name : channels) {
        result.layers.push_back(image.get(name));
        for (float &v : result.layers.back().values)
            v = float(v * factor);
    }
    return result;
}

void write_both(const std::filesystem::path &folder, const std::string &name, const Image &exr, const Image &png) {
    write_exr(exr, folder / (name + ".exr"));
    write_png(png, folder / (name + ".png"));
}

} // namespace

stats::Estimate estimate_of(const Image &image, double samples, double dof) {
    stats::Estimate estimate{image.width, image.height, {}, {}, samples, dof};
    for (const char *name : channels) {
        estimate.mean.emplace_back(image.get(name).values);
        estimate.variance.emplace_back(image.get(std::string("variance.") + name).values);
    }
    return estimate;
}

Image false_colour(const std::vector<float> &values, int width, int height, double limit) {
    Image image{width, height, {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
    for (float value : values) {
        double x = limit > 0 ? value / limit : value == 0 ? 0 : value * std::numeric_limits<double>::infinity();
        float fade = std::isnan(value) ? NAN : float(1 - std::min(1.0, std::abs(x)));
        image.layers[0].values.push_back(x < 0 ? fade : 1);
        image.layers[1].values.push_back(fade);
        image.layers[2].values.push_back(x > 0 ? fade : 1);
    }
    return image;
}

Image difference(const Image &image, const Image &reference) {
    Image result = scaled(image, 1);
    for (Layer &layer : result.layers)
        for (size_t i = 0; i < layer.values.size(); ++i)
            layer.values[i] -= reference.get(layer.name).values[i];
    return result;
}

Image difference_colours(const Image &d) {
    const auto sum = per_pixel(d, [](float r, float g, float b) { return r + g + b; });
    auto size = per_pixel(d, [](float r, float g, float b) { return std::abs(r + g + b); });
    return false_colour(sum, d.width, d.height, quantile(std::move(size), 0.99));
}

Image tile_map(const stats::TileTest &test, const std::vector<double> &values, int width, int height) {
    Image image{width, height, {}, {}};
    size_t tiles = size_t(test.columns) * size_t(test.rows);
    for (size_t c = 0; c < test.channels; ++c) {
        image.layers.push_back({channels[c], {}});
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                image.layers[c].values.push_back(
                    float(values[c * tiles + size_t(y / test.size) * size_t(test.columns) + size_t(x / test.size)]));
    }
    return image;
}

void write_evidence(const std::filesystem::path &folder, const Image &image, const Image &reference,
                    const stats::TileTest &test) {
    std::filesystem::create_directories(folder);
    auto largest = [](float r, float g, float b) { return std::max({r, g, b}); };
    double white = quantile(per_pixel(reference, largest), 0.99);
    double exposure = white > 0 ? 1 / white : 1;
    write_both(folder, "image", image, scaled(image, exposure));
    write_both(folder, "reference", reference, scaled(reference, exposure));
    if (test.p.empty()) // they could not be compared
        return;
    const int w = image.width, h = image.height;
    const Image d = difference(image, reference);
    write_both(folder, "difference", d, difference_colours(d));
    Image z = tile_map(test, test.z, w, h), p = tile_map(test, test.p, w, h);
    auto worst = per_pixel(z, [](float r, float g, float b) {
        return std::max({r, g, b}, [](float x, float y) { return std::abs(x) < std::abs(y); });
    });
    auto darkness = per_pixel(p, [](float r, float g, float b) { return 1 + std::log10(std::min({r, g, b})) / 6; });
    write_both(folder, "z", z, false_colour(worst, w, h, 5));
    write_both(folder, "p", p, Image{w, h, {{"R", darkness}, {"G", darkness}, {"B", darkness}}, {}});
}

std::string describe(const stats::TileTest &test) {
    if (!test.reason.empty())
        return test.reason;
    const stats::PixelBox &tile = test.worst_tile, &box = test.region.box;
    std::string text = fmt::format("p = {:.3g}; worst tile: {} at x {} y {}, z = {:.2f}", test.p_value,
                                   channels[test.worst_channel], tile.x, tile.y, test.worst_z);
    for (size_t c = 0; c < test.whole.size(); ++c)
        text += fmt::format("{}{} {:.3g}", c == 0 ? "; whole image's p: " : ", ", channels[c], test.whole[c].p_value);
    if (test.region.tiles > 0)
        text += fmt::format("; largest region: {} {} tiles within x {}..{} y {}..{}, means {:.4g} and {:.4g}",
                            test.region.tiles, channels[test.region.channel], box.x, box.x + box.width - 1, box.y,
                            box.y + box.height - 1, test.region.mean_a, test.region.mean_b);
    return text;
}

} // namespace opal
