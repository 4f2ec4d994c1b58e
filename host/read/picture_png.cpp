// Pictures from PNG files, by libpng.
#include "image/libpng.h"
#include "read/picture_formats.h"

#include <algorithm>
#include <new>
#include <vector>

namespace opal {
namespace {

void read_bytes(png_structp png, png_bytep to, size_t count) {
    auto &left = *static_cast<std::string_view *>(png_get_io_ptr(png));
    if (count > left.size())
        png_error(png, "the file ends early");
    std::copy_n(left.begin(), count, to);
    left.remove_prefix(count);
}

// libpng's state of a file whose header is read.
struct Reading {
    explicit Reading(std::string_view bytes) : left(bytes) {
        if (!info)
            throw std::bad_alloc();
        png_set_read_fn(png, &left, read_bytes);
    }
    Reading(const Reading &) = delete;
    ~Reading() { png_destroy_read_struct(&png, &info, nullptr); }

    std::string_view left;
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_png_error, ignore_png_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
};

} // namespace

PictureHeader png_header(const std::filesystem::path &, std::string_view bytes) {
    Reading reading(bytes);
    png_read_info(reading.png, reading.info);
    PictureHeader header{};
    Picture &picture = header.picture;
    picture.width = int(png_get_image_width(reading.png, reading.info));
    picture.height = int(png_get_image_height(reading.png, reading.info));
    picture.channels = png_get_color_type(reading.png, reading.info) & PNG_COLOR_MASK_COLOR ? 3 : 1;
    picture.encoded = true;
    const double pixels = double(picture.width) * picture.height;
    const int depth = png_get_bit_depth(reading.png, reading.info);
    constexpr double most_compression = 1032; // of Deflate: 258 bytes by two bits (RFC 1951)
    header.file_bytes = pixels * png_get_channels(reading.png, reading.info) * depth / 8 / most_compression;
    header.memory_bytes = pixels * picture.channels * (depth == 16 ? sizeof(float) + 2 : 1);
    return header;
}

void decode_png(std::string_view bytes, Picture &picture) {
    Reading reading(bytes);
    const png_structp png = reading.png;
    png_read_info(png, reading.info);
    const bool deep = png_get_bit_depth(png, reading.info) == 16;
    if (png_get_color_type(png, reading.info) == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(png);
    else
        png_set_expand_gray_1_2_4_to_8(png);
    png_set_strip_alpha(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, reading.info);
    const size_t row = size_t(picture.width) * size_t(picture.channels) * (deep ? 2 : 1);
    LargeVector<std::uint8_t> all(row * size_t(picture.height));
    std::vector<png_bytep> rows;
    for (int y = 0; y < picture.height; y++)
        rows.push_back(all.data() + size_t(y) * row);
    png_read_image(png, rows.data());
    png_read_end(png, nullptr);
    if (!deep) {
        picture.bytes = std::move(all);
        return;
    }
    picture.floats.reserve(all.size() / 2);
    for (size_t i = 0; i < all.size(); i += 2)
        picture.floats.push_back(float((all[i] * 256 + all[i + 1]) / 65535.0));
}

} // namespace opal
