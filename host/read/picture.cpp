#include "read/picture.h"

#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/read_file.h"
#include "image/image.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>

namespace opal {
namespace {

constexpr std::string_view png_signature("\x89PNG\r\n\x1a\n", 8), exr_signature("\x76\x2f\x31\x01", 4);

struct Reading {
    std::string_view left;
};

void read_bytes(png_structp png, png_bytep to, size_t count) {
    auto &reading = *static_cast<Reading *>(png_get_io_ptr(png));
    if (count > reading.left.size())
        png_error(png, "the file ends early");
    std::copy_n(reading.left.begin(), count, to);
    reading.left.remove_prefix(count);
}

[[noreturn]] void throw_error(png_structp, png_const_charp what) { throw std::runtime_error(what); }
void ignore_warning(png_structp, png_const_charp) {}

// As libpng gives them: 1 or 3 channels of 8 or 16 bits, without alpha.
Picture decoded_png(const std::filesystem::path &file, std::string_view bytes) {
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_error, ignore_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    struct Made {
        png_structp png;
        png_infop info;
        ~Made() { png_destroy_read_struct(&png, &info, nullptr); }
    } const made{png, info};
    if (!info)
        throw std::bad_alloc();
    Reading reading{bytes};
    png_set_read_fn(png, &reading, read_bytes);
    png_read_info(png, info);
    Picture picture;
    picture.width = int(png_get_image_width(png, info));
    picture.height = int(png_get_image_height(png, info));
    const bool deep = png_get_bit_depth(png, info) == 16;
    const int color = png_get_color_type(png, info);
    picture.channels = color & PNG_COLOR_MASK_COLOR ? 3 : 1;
    picture.encoded = true;
    const std::size_t row = std::size_t(picture.width) * std::size_t(picture.channels);
    const std::size_t values = row * std::size_t(picture.height);
    check_memory(double(values) * (deep ? 6 : 1),
                 fmt::format("{}: an image of {} x {} pixels", file.string(), picture.width, picture.height));
    if (color == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(png);
    else
        png_set_expand_gray_1_2_4_to_8(png);
    png_set_strip_alpha(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    std::vector<png_byte> all(values * (deep ? 2 : 1));
    std::vector<png_bytep> rows;
    for (int y = 0; y < picture.height; y++)
        rows.push_back(all.data() + std::size_t(y) * row * (deep ? 2 : 1));
    png_read_image(png, rows.data());
    png_read_end(png, nullptr);
    if (!deep) {
        picture.bytes = std::move(all);
        return picture;
    }
    picture.floats.reserve(values);
    for (std::size_t i = 0; i < values; i++)
        picture.floats.push_back(float((all[2 * i] * 256 + all[2 * i + 1]) / 65535.0));
    return picture;
}

Picture decoded_exr(const std::filesystem::path &file, FileHashes *hashes) {
    const Image image = read_exr(file, hashes);
    Picture picture{image.width, image.height, 3, {}, {}, false};
    const Layer *const channels[] = {&image.get("R"), &image.get("G"), &image.get("B")};
    const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
    picture.floats.resize(3 * pixels);
    std::size_t invalid = 0;
    for (std::size_t i = 0; i < pixels; i++)
        for (std::size_t c = 0; c < 3; c++) {
            const float value = channels[c]->values[i];
            invalid += !std::isfinite(value);
            picture.floats[3 * i + c] = std::isfinite(value) ? value : 0;
        }
    if (invalid > 0)
        warn(fmt::format("{}: {} values are NaN or infinite: they are taken as 0", file.string(), invalid));
    return picture;
}

} // namespace

Picture read_picture(const std::filesystem::path &file, FileHashes *hashes) {
    const std::string bytes = read_file(file, Pipes::refused);
    if (bytes.starts_with(exr_signature))
        return decoded_exr(file, hashes);
    if (!bytes.starts_with(png_signature))
        throw Error(
            fmt::format("{}: this is no image that Opal reads as a texture; possible: PNG, EXR", file.string()));
    if (hashes)
        hashes->add(bytes);
    try {
        return decoded_png(file, bytes);
    } catch (const Error &) {
        throw;
    } catch (const std::runtime_error &error) { // of libpng
        throw Error(fmt::format("{}: cannot be read as a PNG: {}", file.string(), error.what()));
    }
}

std::shared_ptr<const Picture> Pictures::at(const std::filesystem::path &file, FileHashes *hashes) {
    std::shared_ptr<const Picture> &picture = known_[file];
    if (!picture)
        picture = std::make_shared<const Picture>(read_picture(file, hashes));
    return picture;
}

} // namespace opal
