// Linear RGB with the primaries of ITU-R BT.709 (those of sRGB).
#pragma once

#include <array>

namespace opal {

using Color = std::array<double, 3>;

// Relative luminance (Y of CIE XYZ), in the units of the colour.
inline constexpr Color luminance_weights = {0.212671, 0.715160, 0.072169};
inline double luminance(const Color &c) {
    return luminance_weights[0] * c[0] + luminance_weights[1] * c[1] + luminance_weights[2] * c[2];
}

} // namespace opal
