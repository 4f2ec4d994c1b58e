#include "image/image.h"

#include "base/error.h"
#include "base/file_use.h"
#include "image/deflate.h"
#include "image/libpng.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>

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

// The 8 bits of each float. They grow with the float, so that 255 limits say all: found by bisection of the exact
// curve, once an image, instead of a power for each value.
class ByteOfFloat {
public:
    explicit ByteOfFloat(const Display &display) {
        limits_[0] = 0;
        limits_[256] = infinity; // no finite float is above it
        for (unsigned byte = 1; byte < 256; byte++) {
            uint32_t below = limits_[byte - 1], at = infinity;
            while (at - below > 1) {
                const uint32_t middle = below + (at - below) / 2;
                (to_byte(std::bit_cast<float>(middle), display) < byte ? below : at) = middle;
            }
            limits_[byte] = to_byte(std::bit_cast<float>(below), display) < byte ? at : below;
        }
        unsigned byte = 0;
        for (uint32_t cell = 0; cell < lowest_.size(); cell++) {
            while (byte < 255 && limits_[byte + 1] <= cell << cell_bits)
                byte++;
            lowest_[cell] = png_byte(byte);
        }
    }

    png_byte operator()(float finite) const {
        const auto bits = std::bit_cast<uint32_t>(finite);
        if (bits >> 31) // negative
            return 0;
        unsigned byte = lowest_[bits >> cell_bits];
        while (bits >= limits_[byte + 1])
            byte++;
        return png_byte(byte);
    }

private:
    static constexpr uint32_t infinity = 0x7f800000;
    static constexpr unsigned cell_bits = 16;
    std::array<uint32_t, 257> limits_; // the bits of the least float, 0 or above, that has the byte or a larger one
    std::array<png_byte, (infinity >> cell_bits)> lowest_; // the byte of the first float of each cell
};

// The bytes of one row of the image after the other.
class Rows {
public:
    Rows(const Image &image, const Display &display)
        : channels_{&image.get("R"), &image.get("G"), &image.get("B")}, width_(size_t(image.width)), byte_of_(display),
          row_(3 * width_) {}

    std::vector<png_byte> &operator()(size_t y) {
        const size_t first = y * width_;
        for (size_t x = 0; x < width_; ++x) {
            const float rgb[] = {channels_[0]->values[first + x], channels_[1]->values[first + x],
                                 channels_[2]->values[first + x]};
            const bool finite = std::isfinite(rgb[0]) && std::isfinite(rgb[1]) && std::isfinite(rgb[2]);
            for (size_t c = 0; c < 3; ++c)
                row_[3 * x + c] = finite ? byte_of_(rgb[c]) : c == 1 ? 0 : 255;
        }
        return row_;
    }

private:
    const std::array<const Layer *, 3> channels_;
    const size_t width_;
    const ByteOfFloat byte_of_;
    std::vector<png_byte> row_;
};

// Is the picture noise? Looks at some rows, as the differences of neighbours that PNG's filters make of them.
bool is_noisy(Rows &rows, size_t height) {
    constexpr size_t sampled = 16;
    std::vector<unsigned char> bytes;
    for (size_t i = 0; i < std::min(sampled, height); i++) {
        const std::vector<png_byte> &row = rows(i * height / std::min(sampled, height));
        for (size_t k = 3; k < row.size(); k++)
            bytes.push_back(png_byte(row[k] - row[k - 3]));
    }
    return is_noise(bytes);
}

void append_to_string(png_structp png, png_bytep bytes, size_t count) {
    static_cast<std::string *>(png_get_io_ptr(png))->append(reinterpret_cast<const char *>(bytes), count);
}

std::string png_bytes(const Image &image, const Display &display) {
    constexpr int level =
        3; // of zlib, for repetitions: 6, the default, saves a tenth of the bytes in six times the time
    std::string bytes;
    Rows rows(image, display);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_png_error, ignore_png_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    struct Made {
        png_structp png;
        png_infop info;
        ~Made() { png_destroy_write_struct(&png, &info); }
    } const made{png, info};
    if (!info)
        throw std::bad_alloc();
    png_set_write_fn(png, &bytes, append_to_string, nullptr);
    png_set_IHDR(png, info, png_uint_32(image.width), png_uint_32(image.height), 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    const bool noise = is_noisy(rows, size_t(image.height));
    png_set_compression_strategy(png, noise ? Z_RLE : Z_DEFAULT_STRATEGY);
    png_set_compression_level(png, level);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_AVG);
    png_write_info(png, info);
    for (size_t y = 0; y < size_t(image.height); y++)
        png_write_row(png, rows(y).data());
    png_write_end(png, info);
    return bytes;
}

} // namespace

double srgb_encode(double linear) {
    const double x = std::clamp(linear, 0.0, 1.0);
    return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
}

std::filesystem::path png_beside(const std::filesystem::path &exr) {
    std::error_code ignored;
    const std::filesystem::file_status status = std::filesystem::status(exr, ignored);
    const bool special = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
    return special || descriptor_of(exr) ? std::filesystem::path()
                                         : std::filesystem::path(exr).replace_extension(".png");
}

void check_png_size(int width, int height) {
    constexpr int most = PNG_USER_WIDTH_MAX; // what programs with libpng read
    static_assert(most == PNG_USER_HEIGHT_MAX);
    if (width > most || height > most)
        throw Error(
            fmt::format("a PNG holds at most {} pixels a side, and the image has {} x {}", most, width, height));
}

void write_png(const Image &image, const std::filesystem::path &file, const Display &display) {
    std::string bytes;
    try {
        bytes = png_bytes(image, display);
    } catch (const std::runtime_error &error) { // of libpng
        throw Error(fmt::format("{}: cannot be written: {}", file.string(), error.what()));
    }
    write_safely(file, bytes);
}

} // namespace opal
