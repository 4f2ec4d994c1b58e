#include "read/texture_values.h"

#include "base/log.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {
namespace {

struct Bounds {
    double least = 0, most = 0;
};

template <class Values> Bounds bounds_of_all(const Values &values) {
    if (values.empty())
        return {};
    const auto [least, most] = std::ranges::minmax(values);
    return {least, most};
}

Bounds bounds_of(const CheckerboardTexture &texture) {
    const auto [least, most] = std::minmax({std::ranges::min(texture.color0), std::ranges::min(texture.color1),
                                            std::ranges::max(texture.color0), std::ranges::max(texture.color1)});
    return {least, most};
}
// Bytes are shares of 255, and the curve of sRGB keeps 0 to 1.
Bounds bounds_of(const BitmapTexture &texture) { return bounds_of_all(texture.picture->floats); }

Bounds bounds_of(const MeshAttributeTexture &texture) {
    const Bounds of = texture.attribute ? bounds_of_all(texture.attribute->values) : Bounds();
    const auto [least, most] = std::minmax({texture.scale * of.least, texture.scale * of.most});
    return {least, most};
}

} // namespace

void warn_of_values(const SourcePlace &place, const Parameter &parameter, const Texture &texture, double factor) {
    if (parameter.type != ParameterType::COLOR && parameter.range.most != 1)
        return;
    const Bounds of = std::visit([](const auto &own) { return bounds_of(own); }, texture);
    if (factor * of.least < 0 || factor * of.most > 1)
        warn(fmt::format("{}: the texture has values from {:.4g} to {:.4g} where 0 to 1 are meant: surfaces may shed "
                         "more light than meets them, or less than none",
                         place.text(), factor * of.least, factor * of.most));
}

} // namespace opal
