// sRGB (IEC 61966-2-1): its curve and its primaries, which are those of ITU-R BT.709.
#pragma once

#include "base/color.h"

#include <array>

namespace opal {

// The linear value of a number that the curve encodes. Both are 1 for 1.
double srgb_decode(double encoded);

// What bytes mean that stand for 0 to 1: as numbers, or encoded by the curve.
const std::array<double, 256> &decoded_bytes(bool encoded);

// Linear RGB of CIE XYZ, whose white is D65.
Color linear_rgb_of_xyz(double x, double y, double z);

} // namespace opal
