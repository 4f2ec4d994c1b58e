#include "scene/environment.h"

#include "base/color.h"
#include "base/error.h"
#include "base/log.h"
#include "base/srgb.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace opal {
namespace {

constexpr int fewest_rows = 3;                            // so that a row lies between those of the poles
constexpr std::size_t most_texels = std::size_t(1) << 28; // words of so many EnvironmentTexels have an index of 31 bits

// Linear values, three a pixel.
LargeVector<float> decoded(Picture &picture) {
    if (picture.bytes.empty() && picture.channels == 3 && !picture.encoded)
        return std::move(picture.floats);
    const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
    const auto channels = std::size_t(picture.channels);
    const auto &bytes = decoded_bytes(picture.encoded);
    LargeVector<float> values(3 * pixels);
    for (std::size_t i = 0; i < pixels; i++)
        for (std::size_t c = 0; c < 3; c++) {
            const std::size_t at = channels * i + c % channels;
            const double value = !picture.bytes.empty() ? bytes[picture.bytes[at]]
                                 : picture.encoded      ? srgb_decode(picture.floats[at])
                                                        : double(picture.floats[at]);
            values[3 * i + c] = float(value);
        }
    return values;
}

void remove_invalid(LargeVector<float> &values, const std::filesystem::path &file) {
    std::size_t invalid = 0;
    for (float &value : values)
        if (!(value >= 0) || std::isinf(value)) {
            value = 0;
            invalid++;
        }
    if (invalid > 0)
        warn(fmt::format("{}: {} values are negative or no finite numbers: they are taken as 0", file.string(),
                         invalid));
}

// One row becomes three, two become three with their mean between them.
void add_rows(EnvironmentMap &map) {
    const std::size_t row = 3 * std::size_t(map.width);
    if (map.height >= fewest_rows)
        return;
    LargeVector<float> &values = map.texels;
    values.resize(fewest_rows * row);
    for (std::size_t i = 0; i < row; i++) {
        const float first = values[i], last = values[std::size_t(map.height - 1) * row + i];
        values[2 * row + i] = last;
        values[row + i] = first / 2 + last / 2;
    }
    map.height = fewest_rows;
}

// The mean over the sphere of a function that is linear in the polar angle between rows: with h the angle between two
// rows, the integral of a row's hat function times the sine is sin(theta) 2 (1 - cos h) / h, at a pole 1 - sin(h) / h.
double mean_over_directions(const EnvironmentMap &map) {
    const double h = std::numbers::pi / (map.height - 1), at_pole = 1 - std::sin(h) / h,
                 between = 4 * std::pow(std::sin(h / 2), 2) / h;
    double mean = 0;
    std::size_t texel = 0;
    for (int y = 0; y < map.height; y++) {
        double row = 0;
        for (int x = 0; x < map.width; x++)
            row += map.luminance_at(texel++);
        const bool is_pole = y == 0 || y == map.height - 1;
        mean += row / map.width * (is_pole ? at_pole : between * std::sin(y * h)) / 2;
    }
    return mean;
}

Vec3 column(const Transform &t, std::size_t i) { return {t.rows[0][i], t.rows[1][i], t.rows[2][i]}; }

} // namespace

float EnvironmentMap::luminance_at(std::size_t texel) const {
    const float *const color = &texels[3 * texel];
    return float(luminance({color[0], color[1], color[2]}));
}

std::shared_ptr<const EnvironmentMap> environment_of(Picture picture, const std::filesystem::path &file) {
    if (std::size_t(picture.width) * std::size_t(picture.height) > most_texels)
        throw Error(fmt::format("{}: an environment has at most 2^28 pixels, this one has {} x {}", file.string(),
                                picture.width, picture.height));
    auto map = std::make_shared<EnvironmentMap>();
    map->width = picture.width;
    map->height = picture.height;
    map->texels = decoded(picture);
    remove_invalid(map->texels, file);
    add_rows(*map);
    map->mean_luminance = mean_over_directions(*map);
    return map;
}

Transform orthonormal(const Transform &transform) {
    const Vec3 x = column(transform, 0), y = normalize(column(transform, 1));
    const Vec3 across = normalize(x - y * dot(x, y));
    const Vec3 z = cross(across, y) * (transform.determinant() < 0 ? -1.0 : 1.0);
    Transform result;
    for (int i = 0; i < 3; i++)
        result.rows[std::size_t(i)] = {across[i], y[i], z[i], 0};
    return result;
}

} // namespace opal
