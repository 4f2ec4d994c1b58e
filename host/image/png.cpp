#include "image/image.h"

#include "base/error.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>

namespace opal {

namespace {

// Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2015: a fit of ACES's reference and output transforms, for
// each channel alone. A value of 1 becomes 0.8.
double aces_curve(double x) {
    x = std::max(x, 0.0);
    return std::isinf(x) ? 1 : x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

png_byte to_byte(double linear, const Display &display) {
    const double exposed = std::exp2(display.exposure) * linear;
    const double shown = display.tonemap == Tonemap::aces ? aces_curve(exposed) : exposed;
    return static_cast<png_byte>(std::floor(255 * srgb_encode(shown) + 0.5));
}

std::vector<png_byte> rgb_bytes(const Image &image, const Display &display) {
    const Layer *channels[] = {&image.get("R"), &image.get("G"), &image.get("B")};
    const size_t pixels = size_t(image.width) * size_t(image.height);
    std::vector<png_byte> bytes(3 * pixels);
    for (size_t i = 0; i < pixels; ++i) {
        const float rgb[] = {channels[0]->values[i], channels[1]->values[i], channels[2]->values[i]};
        const bool finite = std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]);
        for (size_t c = 0; c < 3; ++c)
            bytes[3 * i + c] = finite ? to_byte(rgb[c], display) : c == 1 ? 0 : 255;
    }
    return bytes;
}

} // namespace

double srgb_encode(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

void write_png(const Image &image, const std::filesystem::path &file, const Display &display) {
    const std::vector<png_byte> pixels = rgb_bytes(image, display);
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = PNG_FORMAT_RGB;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string bytes(size, '\0');
    if (!png_image_write_to_memory(&header, bytes.data(), &size, 0, pixels.data(), 0, nullptr))
        throw Error(fmt::format("{}: cannot be written: {}", file.string(), header.message));
    bytes.resize(size);
    write_safely(file, bytes);
}

} // namespace opal
