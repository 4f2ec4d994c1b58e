// Pictures of textures: Radiance HDR by Opal's own parser, and the headers of PNG and JPEG before their libraries
// decode them (those of OpenEXR: exr.cpp).
#include "read/picture.h"
#include "base/error.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"
#include "image/libpng.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

namespace opal::fuzz {

namespace {

std::string any_bytes(size_t count, Random &random) {
    std::string bytes;
    for (size_t i = 0; i < count; i++)
        bytes += char(below(256, random));
    return bytes;
}

// A line of the width, its channels in runs and in bytes as they are.
std::string new_line(size_t width, Random &random) {
    std::string line = {2, 2, char(width >> 8), char(width & 255)};
    for (int channel = 0; channel < 4; channel++)
        for (size_t at = 0; at < width;) {
            const size_t count = 1 + below(std::min<size_t>(width - at, 127), random);
            const bool repeats = below(2, random) == 0;
            line += char(count + (repeats ? 128 : 0)) + any_bytes(repeats ? 1 : count, random);
            at += count;
        }
    return line;
}

// A pixel that is repeated, by one number or two, then others.
std::string old_line(size_t width, Random &random) {
    std::string line = any_bytes(4, random);
    size_t left = width - 1;
    if (left > 256 && below(2, random) == 0) {
        line += std::string("\1\1\1") + char(left & 255) + "\1\1\1" + char(left >> 8);
        left = 0;
    } else if (const size_t run = below(std::min<size_t>(left, 255) + 1, random)) {
        line += std::string("\1\1\1") + char(run);
        left -= run;
    }
    return line + any_bytes(4 * left, random);
}

std::string hdr_file(Random &random) {
    const size_t width = 1 + below(below(4, random) == 0 ? 600 : 40, random), height = 1 + below(4, random);
    std::string file =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
    for (size_t y = 0; y < height; y++)
        file += width >= 8 && below(3, random) > 0 ? new_line(width, random) : old_line(width, random);
    return file;
}

std::string png_file(Random &random) {
    std::string file;
    const int depth = 1 << below(5, random), width = 1 + int(below(9, random)), height = 1 + int(below(5, random));
    const bool deep = depth >= 8;
    const int type = deep && below(2, random) == 0 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_GRAY;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_png_error, ignore_png_warning);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &file,
        [](png_structp to, png_bytep bytes, size_t count) {
            static_cast<std::string *>(png_get_io_ptr(to))->append(reinterpret_cast<const char *>(bytes), count);
        },
        nullptr);

    png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), depth, type,
                 below(2, random) == 0 ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    std::string row = any_bytes(png_get_rowbytes(png, info), random);
    std::vector<png_bytep> rows(size_t(height), reinterpret_cast<png_bytep>(row.data()));
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    return file;
}

std::string jpeg_file(Random &random) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char *made = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &made, &size);
    jpeg.image_width = JDIMENSION(1 + below(20, random));
    jpeg.image_height = JDIMENSION(1 + below(20, random));
    const bool grey = below(2, random) == 0;
    jpeg.input_components = grey ? 1 : 3;
    jpeg.in_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&jpeg);
    if (below(2, random) == 0)
        jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
        std::string line = any_bytes(3 * jpeg.image_width, random);
        JSAMPROW row = reinterpret_cast<JSAMPROW>(line.data());
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::string file(reinterpret_cast<const char *>(made), size);
    std::free(made);
    return file;
}

const TextFormat format = {
    .words = [](std::string_view text) { return separated(text, " \n="); },
    .replacements = {"-Y", "+X", "+Y", "FORMAT=32-bit_rle_rgbe", "32-bit_rle_xyze", "EXPOSURE=2", "\n\n",
                     std::string("\2\2\0\10", 4), "\1\1\1\xff", "0", "1", "32767", "2147483647"},
    .piece = '\n',
    .start =
        [](Random &random) {
            const size_t kind = below(4, random);
            return kind == 0 ? png_file(random) : kind == 1 ? jpeg_file(random) : hdr_file(random);
        }};

} // namespace

void try_input(std::string_view input) {
    static ServedFile file("picture");
    file.write(input);
    try {
        const Picture picture = read_picture(file.path());
        require(picture.channels == 1 || picture.channels == 3, "a picture has one or three channels");
        const size_t values = size_t(picture.width) * size_t(picture.height) * size_t(picture.channels);
        require(picture.bytes.size() == values || picture.floats.size() == values, "each texel has its values");
        require(picture.bytes.empty() || picture.floats.empty(), "values are bytes or floats");
        for (const float value : picture.floats)
            require(std::isfinite(value), "values are finite");
    } catch (const Error &) {
    }
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return opal::fuzz::mutate(opal::fuzz::format, data, size, max_size, seed);
}
