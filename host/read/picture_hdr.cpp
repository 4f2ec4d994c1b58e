// Pictures from Radiance HDR files (Ward, "Real Pixels", Graphics Gems II, 1991): three mantissas of 8 bits and the
// exponent that they share.
#include "base/log.h"
#include "read/picture_formats.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace opal {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

constexpr int least_new_width = 8, most_new_width = 32767; // of lines whose channels are compressed singly

std::string_view take(std::string_view &bytes, size_t count) {
    if (count > bytes.size())
        throw std::runtime_error("the file ends early");
    const std::string_view taken = bytes.substr(0, count);
    bytes.remove_prefix(count);
    return taken;
}

std::uint8_t take_byte(std::string_view &bytes) { return std::uint8_t(take(bytes, 1)[0]); }

Rgbe take_pixel(std::string_view &bytes) {
    const std::string_view taken = take(bytes, 4);
    return {std::uint8_t(taken[0]), std::uint8_t(taken[1]), std::uint8_t(taken[2]), std::uint8_t(taken[3])};
}

std::string_view take_line(std::string_view &bytes) {
    const size_t end = bytes.find('\n');
    if (end == bytes.npos)
        throw std::runtime_error("its header does not end");
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    return line;
}

std::string_view take_word(std::string_view &line) {
    const size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const size_t end = std::min(line.find(' ', begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

int take_side(std::string_view &line, std::string_view axis, std::string_view all) {
    int side = 0;
    const bool right_axis = take_word(line) == axis;
    const std::string_view number = take_word(line);
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), side);
    if (!right_axis || error != std::errc() || end != number.data() + number.size() || side <= 0)
        throw std::runtime_error(
            fmt::format("its size is '{}', and Opal reads '-Y HEIGHT +X WIDTH' alone, rows from the top", all));
    return side;
}

struct Header {
    int width, height;
    std::string ignored; // a line whose factors are not applied
    std::string_view pixels;
};

Header parse(std::string_view bytes) {
    Header header{};
    take_line(bytes); // the magic
    for (std::string_view line = take_line(bytes); !line.empty(); line = take_line(bytes)) {
        if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
            throw std::runtime_error(fmt::format("it says {}, and Opal reads FORMAT=32-bit_rle_rgbe alone", line));
        if (line.starts_with("EXPOSURE=") || line.starts_with("COLORCORR="))
            header.ignored = line;
    }
    std::string_view size = take_line(bytes);
    const std::string_view all = size;
    header.height = take_side(size, "-Y", all);
    header.width = take_side(size, "+X", all);
    header.pixels = bytes;
    return header;
}

// The fewest bytes of a line: a pixel, and repetitions of 255, 255 * 256, ... pixels by four bytes each.
double least_line_bytes(int width) {
    double bytes = sizeof(Rgbe), pixels = 1;
    for (double run = 255; pixels < width; run *= 256, bytes += sizeof(Rgbe))
        pixels += run;
    return bytes;
}

void check_run(size_t at, size_t run, size_t width) {
    if (run > width - at)
        throw std::runtime_error("a run passes the end of its line");
}

// The channels one after the other, each in runs and in bytes as they are.
void read_new_line(std::string_view &bytes, std::vector<Rgbe> &line) {
    constexpr size_t most_literal = 128;
    for (size_t channel = 0; channel < sizeof(Rgbe); channel++)
        for (size_t at = 0; at < line.size();) {
            const size_t code = take_byte(bytes);
            const bool repeats = code > most_literal;
            const size_t count = repeats ? code - most_literal : code;
            if (count == 0)
                throw std::runtime_error("a run has no pixels");
            check_run(at, count, line.size());
            const std::string_view values = take(bytes, repeats ? 1 : count);
            for (size_t i = 0; i < count; i++)
                line[at++][channel] = std::uint8_t(values[repeats ? 0 : i]);
        }
}

// Pixels as they are. One of mantissas 1 1 1 repeats the pixel before; several in a row make one number, its lowest
// byte first.
void read_old_line(std::string_view &bytes, const Rgbe &first, std::vector<Rgbe> &line) {
    unsigned shift = 0;
    Rgbe pixel = first;
    for (size_t at = 0; at < line.size();) {
        if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
            if (at == 0 || shift > 24)
                throw std::runtime_error("a repetition has no pixel before it, or too many digits");
            const size_t run = size_t(pixel[3]) << shift;
            check_run(at, run, line.size());
            std::fill_n(line.begin() + std::ptrdiff_t(at), run, line[at - 1]);
            at += run;
            shift += 8;
        } else {
            line[at++] = pixel;
            shift = 0;
        }
        if (at < line.size())
            pixel = take_pixel(bytes);
    }
}

} // namespace

PictureHeader hdr_header(const std::filesystem::path &file, std::string_view bytes) {
    const Header read = parse(bytes);
    if (!read.ignored.empty())
        note(fmt::format("{}: {} is not applied: values are taken as they stand, as Mitsuba does", file.string(),
                         read.ignored));
    PictureHeader header{};
    header.picture.width = read.width;
    header.picture.height = read.height;
    header.picture.channels = 3;
    header.file_bytes = least_line_bytes(read.width) * read.height;
    header.memory_bytes = double(read.width) * read.height * 3 * sizeof(float);
    return header;
}

void decode_hdr(std::string_view bytes, Picture &picture) {
    // Writers cut mantissas: the middle of a step is right in the mean.
    constexpr int bias = 128, mantissa_bits = 8;
    std::array<float, 256> scale{};
    for (int exponent = 1; exponent < 256; exponent++)
        scale[size_t(exponent)] = float(std::ldexp(1, exponent - bias - mantissa_bits));
    bytes = parse(bytes).pixels;
    std::vector<Rgbe> line(size_t(picture.width));
    picture.floats.reserve(3 * line.size() * size_t(picture.height));
    for (int y = 0; y < picture.height; y++) {
        const Rgbe first = take_pixel(bytes);
        const bool is_new = picture.width >= least_new_width && picture.width <= most_new_width && first[0] == 2 &&
                            first[1] == 2 && first[2] < 128;
        if (!is_new)
            read_old_line(bytes, first, line);
        else if (first[2] * 256 + first[3] != picture.width)
            throw std::runtime_error("a line is not as wide as the image");
        else
            read_new_line(bytes, line);
        for (const Rgbe &pixel : line) {
            const bool black = pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0;
            for (size_t c = 0; c < 3; c++)
                picture.floats.push_back(black ? 0 : (float(pixel[c]) + 0.5f) * scale[pixel[3]]);
        }
    }
}

} // namespace opal
