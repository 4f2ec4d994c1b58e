// The textures of materials, in double precision.
#pragma once

#include "base/color.h"

#include <array>
#include <string>
#include <variant>

namespace opal {

// The map from a surface's texture coordinates (u, v, 1) to the texture's own.
using UvTransform = std::array<std::array<double, 3>, 2>;
constexpr UvTransform identity_uv = {{{1, 0, 0}, {0, 1, 0}}};

struct CheckerboardTexture { // two by two squares in the unit square
    Color color0{0.4, 0.4, 0.4}, color1{0.2, 0.2, 0.2};
    UvTransform to_uv = identity_uv;
};

using Texture = std::variant<CheckerboardTexture>;

} // namespace opal
