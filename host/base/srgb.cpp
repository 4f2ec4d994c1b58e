#include "base/srgb.h"

#include <cmath>

namespace opal {

double srgb_decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

const std::array<double, 256> &decoded_bytes(bool encoded) {
    using Bytes = std::array<double, 256>;
    static const std::array<Bytes, 2> values = [] {
        std::array<Bytes, 2> both{};
        for (std::size_t byte = 0; byte < both[0].size(); byte++) {
            both[0][byte] = double(byte) / 255;
            both[1][byte] = srgb_decode(both[0][byte]);
        }
        return both;
    }();
    return values[encoded];
}

Color linear_rgb_of_xyz(double x, double y, double z) {
    return {3.240479 * x - 1.537150 * y - 0.498535 * z, -0.969256 * x + 1.875991 * y + 0.041556 * z,
            0.055648 * x - 0.204043 * y + 1.057311 * z};
}

} // namespace opal
