#include "flatten/texture_mean.h"

#include "base/srgb.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace opal {

namespace {

struct Uv {
    double u, v;
};

Uv mapped(const UvTransform &to_uv, Uv uv) {
    return {to_uv[0][0] * uv.u + to_uv[0][1] * uv.v + to_uv[0][2],
            to_uv[1][0] * uv.u + to_uv[1][1] * uv.v + to_uv[1][2]};
}

Color value_at(const CheckerboardTexture &texture, Uv uv) {
    const auto in_first_half = [](double x) { return x - std::floor(x) <= 0.5; };
    const auto [u, v] = mapped(texture.to_uv, uv);
    return in_first_half(u) == in_first_half(v) ? texture.color0 : texture.color1;
}

int wrapped_texel(double texel, int n, uint wrap) {
    if (wrap == WRAP_clamp)
        return int(std::clamp<double>(texel, 0, n - 1));
    const double period = wrap == WRAP_mirror ? 2.0 * n : n, within = texel - period * std::floor(texel / period);
    return std::max(0, int(within < n ? within : 2 * n - 1 - within));
}

Color texel_at(const BitmapTexture &texture, double x, double y) {
    const Picture &picture = *texture.picture;
    const bool encoded = picture.encoded && !texture.raw;
    const auto first = (std::size_t(wrapped_texel(y, picture.height, texture.wrap)) * std::size_t(picture.width) +
                        std::size_t(wrapped_texel(x, picture.width, texture.wrap))) *
                       std::size_t(picture.channels);
    const auto value = [&](std::size_t i) {
        if (!picture.bytes.empty())
            return decoded_bytes(encoded)[picture.bytes[i]];
        return encoded ? srgb_decode(picture.floats[i]) : double(picture.floats[i]);
    };
    if (picture.channels == 1)
        return {value(first), value(first), value(first)};
    return {value(first), value(first + 1), value(first + 2)};
}

Color mixed(const Color &a, const Color &b, double share) {
    return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
}

Color value_at(const BitmapTexture &texture, Uv uv) {
    auto [u, v] = mapped(texture.to_uv, uv);
    if (!std::isfinite(u + v))
        u = v = 0;
    const double half = texture.nearest ? 0 : 0.5;
    const double x = u * texture.picture->width - half, y = v * texture.picture->height - half;
    const double left = std::floor(x), top = std::floor(y);
    if (texture.nearest)
        return texel_at(texture, left, top);
    const auto row = [&](double at) {
        return mixed(texel_at(texture, left, at), texel_at(texture, left + 1, at), x - left);
    };
    return mixed(row(top), row(top + 1), y - top);
}

// An attribute is known by the point of its mesh, not by texture coordinates.
Color value_at(const MeshAttributeTexture &, Uv) { return {}; }

// Point `i` of the R2 sequence in the unit square: multiples of 1 / g and 1 / g^2 modulo 1, where g^3 = g + 1.
Uv r2_point(std::size_t i) {
    constexpr double g = 1.32471795724474602596;
    const double x = 0.5 + double(i) / g, y = 0.5 + double(i) / (g * g);
    return {x - std::floor(x), y - std::floor(y)};
}

} // namespace

Color color_at(const Texture &texture, double u, double v) {
    return std::visit([&](const auto &own) { return value_at(own, Uv{u, v}); }, texture);
}

Color mean_over_triangles(const Texture &texture, std::span<const TriangleUv> triangles,
                          const std::vector<double> &areas, std::size_t lookups) {
    double area = 0;
    for (const double one : areas)
        area += one;
    Color mean{};
    for (std::size_t i = 0; i < triangles.size(); i++) {
        const std::size_t count = 1 + std::size_t(double(lookups) * areas[i] / area);
        for (std::size_t k = 0; k < count; k++) {
            auto [b1, b2] = count == 1 ? Uv{1 / 3.0, 1 / 3.0} : r2_point(k);
            if (b1 + b2 > 1)
                b1 = 1 - b1, b2 = 1 - b2;
            const auto &c = triangles[i].corner;
            const double b0 = 1 - b1 - b2;
            const Color color = color_at(texture, b0 * c[0][0] + b1 * c[1][0] + b2 * c[2][0],
                                         b0 * c[0][1] + b1 * c[1][1] + b2 * c[2][1]);
            for (std::size_t channel = 0; channel < 3; channel++)
                mean[channel] += areas[i] / area / double(count) * color[channel];
        }
    }
    return mean;
}

Color mean_over_sphere(const Texture &texture, std::size_t lookups) {
    Color mean{};
    for (std::size_t k = 0; k < lookups; k++) {
        const auto [u, share] = r2_point(k);
        const Color color = color_at(texture, u, std::acos(1 - 2 * share) / std::numbers::pi);
        for (std::size_t channel = 0; channel < 3; channel++)
            mean[channel] += color[channel] / double(lookups);
    }
    return mean;
}

} // namespace opal
