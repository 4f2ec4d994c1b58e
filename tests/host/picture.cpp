// Pictures of textures: what each form of PNG, JPEG, Radiance HDR and OpenEXR becomes, and files that are cut off,
// claim too much or are something else.
#include "base/error.h"
#include "base/log.h"
#include "image/image.h"
#include "image/libpng.h"
#include "read/picture_loader.h"
#include "support/scratch.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledOutputPart.h>
#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <half.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include <jpeglib.h>

using namespace opal;
using opal::test::ScratchFolder;
using Bytes = std::vector<std::uint8_t>;
using namespace std::literals;

namespace {

struct PngForm {
    int width, height, depth, type;
    Bytes samples; // as the rows of the file hold them
    bool interlaced = false;
    std::vector<png_color> palette{};
    Bytes alphas{}; // of the palette
    bool linear_gamma = false;
};

void append_bytes(png_structp png, png_bytep bytes, size_t count) {
    static_cast<std::string *>(png_get_io_ptr(png))->append(reinterpret_cast<const char *>(bytes), count);
}

// Without samples the rows' data end after four bytes.
std::string png_of(PngForm form) {
    std::string bytes;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throw_png_error, ignore_png_warning);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(png, &bytes, append_bytes, [](png_structp) {});
    png_set_IHDR(png, info, png_uint_32(form.width), png_uint_32(form.height), form.depth, form.type,
                 form.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (form.linear_gamma)
        png_set_gAMA(png, info, 1);
    if (!form.palette.empty())
        png_set_PLTE(png, info, form.palette.data(), int(form.palette.size()));
    if (!form.alphas.empty())
        png_set_tRNS(png, info, form.alphas.data(), int(form.alphas.size()), nullptr);
    png_write_info(png, info);
    if (!form.samples.empty()) {
        std::vector<png_bytep> rows;
        for (int y = 0; y < form.height; y++)
            rows.push_back(&form.samples[size_t(y) * png_get_rowbytes(png, info)]);
        png_write_image(png, rows.data());
        png_write_end(png, info);
    } else {
        png_write_chunk(png, reinterpret_cast<png_const_bytep>("IDAT"), Bytes(4).data(), 4);
    }
    png_destroy_write_struct(&png, &info);
    return bytes;
}

std::string jpeg_of(int width, int height, J_COLOR_SPACE space, Bytes samples, bool progressive = false) {
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    unsigned char *made = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&jpeg, &made, &size);
    jpeg.image_width = JDIMENSION(width);
    jpeg.image_height = JDIMENSION(height);
    jpeg.input_components = int(samples.size()) / (width * height);
    jpeg.in_color_space = space;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, 95, TRUE);
    if (progressive)
        jpeg_simple_progression(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    for (int y = 0; y < height; y++) {
        JSAMPROW row = &samples[size_t(y * width * jpeg.input_components)];
        jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::string bytes(reinterpret_cast<const char *>(made), size);
    std::free(made);
    return bytes;
}

// A ramp of red to the right, of green downwards.
Bytes ramps(int width, int height) {
    Bytes samples;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            samples.insert(samples.end(), {std::uint8_t(255 * x / (width - 1)), std::uint8_t(255 * y / (height - 1)),
                                           std::uint8_t(60)});
    return samples;
}

const std::string hdr_start = "#?RADIANCE\n# by hand\nFORMAT=32-bit_rle_rgbe\n\n";
std::string hdr_of(int width, int height, const std::string &pixels) {
    return hdr_start + fmt::format("-Y {} +X {}\n", height, width) + pixels;
}

struct Channel {
    std::string name;
    std::vector<float> values;
    Imf::PixelType type = Imf::FLOAT;
};
struct Part {
    std::string name;
    std::vector<Channel> channels;
};

// Scanlines, or tiles; first: of the data window.
void write_parts(const std::filesystem::path &file, int width, const std::vector<Part> &parts, bool tiled = false,
                 int first = 0) {
    std::vector<Imf::Header> headers;
    for (const Part &part : parts) {
        const int height = int(part.channels.front().values.size()) / width;
        const Imath::Box2i data({first, first}, {first + width - 1, first + height - 1});
        Imf::Header header(first ? Imath::Box2i({0, 0}, {9, 9}) : data, data);
        header.setName(part.name);
        header.setType(tiled ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
        if (tiled)
            header.setTileDescription(Imf::TileDescription(2, 2));
        for (const Channel &channel : part.channels)
            header.channels().insert(channel.name, Imf::Channel(channel.type));
        headers.push_back(header);
    }
    Imf::MultiPartOutputFile output(file.c_str(), headers.data(), int(headers.size()));
    for (int i = 0; i < int(parts.size()); i++) {
        Imf::FrameBuffer frame;
        std::vector<std::vector<half>> halves(parts[size_t(i)].channels.size());
        const int height = int(parts[size_t(i)].channels.front().values.size()) / width;
        auto own = halves.begin();
        for (const Channel &channel : parts[size_t(i)].channels) {
            own->assign(channel.values.begin(), channel.values.end());
            const bool is_half = channel.type == Imf::HALF;
            const size_t size = is_half ? sizeof(half) : sizeof(float);
            char *const start = const_cast<char *>(is_half ? reinterpret_cast<const char *>(own->data())
                                                           : reinterpret_cast<const char *>(channel.values.data()));
            frame.insert(channel.name, Imf::Slice(channel.type, start - size_t(first + first * width) * size, size,
                                                  size * size_t(width)));
            ++own;
        }
        if (tiled) {
            Imf::TiledOutputPart part(output, i);
            part.setFrameBuffer(frame);
            part.writeTiles(0, part.numXTiles() - 1, 0, part.numYTiles() - 1);
        } else {
            Imf::OutputPart part(output, i);
            part.setFrameBuffer(frame);
            part.writePixels(height);
        }
    }
}

struct PictureFixture {
    ScratchFolder scratch;

    Picture read(const std::string &bytes, const std::string &name = "a") const {
        return read_picture(scratch.write(name, bytes));
    }
    std::string error_in(const std::string &bytes) const {
        try {
            read(bytes);
        } catch (const Error &error) {
            const std::string message = error.what(), file = (scratch / "a").string() + ": ";
            return message.starts_with(file) ? message.substr(file.size()) : "no name: " + message;
        }
        return "";
    }
};

Bytes bytes_of(const Picture &picture) { return {picture.bytes.begin(), picture.bytes.end()}; }
std::vector<float> floats_of(const Picture &picture) { return {picture.floats.begin(), picture.floats.end()}; }

} // namespace

TEST_CASE_METHOD(PictureFixture, "PNG: depths, palettes, alpha, interlacing", "[picture]") {
    const Picture grey = read(png_of({3, 1, 8, PNG_COLOR_TYPE_GRAY, {0, 60, 255}, false, {}, {}, true}));
    CHECK(grey.width == 3);
    CHECK(grey.height == 1);
    CHECK(grey.channels == 1);
    CHECK(grey.encoded); // whatever gAMA says
    CHECK(bytes_of(grey) == Bytes{0, 60, 255});
    CHECK(bytes_of(read(png_of({4, 1, 1, PNG_COLOR_TYPE_GRAY, {0b01100000}}))) == Bytes{0, 255, 255, 0});
    CHECK(bytes_of(read(png_of({2, 1, 4, PNG_COLOR_TYPE_GRAY, {0x3f}}))) == Bytes{51, 255});
    const Picture with_alpha = read(png_of({2, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, {10, 0, 20, 128}}));
    CHECK(with_alpha.channels == 1);
    CHECK(bytes_of(with_alpha) == Bytes{10, 20});
    CHECK(bytes_of(read(png_of({2, 1, 8, PNG_COLOR_TYPE_RGB_ALPHA, {255, 0, 0, 0, 255, 255, 255, 128}}))) ==
          Bytes{255, 0, 0, 255, 255, 255});
    const Picture palette = read(
        png_of({3, 1, 2, PNG_COLOR_TYPE_PALETTE, {0b00011000}, false, {{9, 8, 7}, {1, 2, 3}, {4, 5, 6}}, {0, 128}}));
    CHECK(palette.channels == 3);
    CHECK(bytes_of(palette) == Bytes{9, 8, 7, 1, 2, 3, 4, 5, 6});
    const Bytes many = ramps(13, 9);
    CHECK(bytes_of(read(png_of({13, 9, 8, PNG_COLOR_TYPE_RGB, many, true}))) == many);
    const Picture deep =
        read(png_of({2, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA, {0, 1, 1, 0, 255, 255, 0, 0, 128, 128, 0, 0, 0, 0, 9, 9}}));
    CHECK(deep.encoded);
    CHECK(deep.bytes.empty());
    CHECK(floats_of(deep) ==
          std::vector<float>{float(1 / 65535.), float(256 / 65535.), 1, float(32896 / 65535.), 0, 0});
}

TEST_CASE_METHOD(PictureFixture, "JPEG: baseline and progressive, grey and colour", "[picture]") {
    const Bytes samples = ramps(40, 24);
    for (const bool progressive : {false, true}) {
        const std::string file = jpeg_of(40, 24, JCS_RGB, samples, progressive);
        const Picture picture = read(file);
        CHECK(picture.width == 40);
        CHECK(picture.height == 24);
        CHECK(picture.channels == 3);
        CHECK(picture.encoded);
        REQUIRE(picture.bytes.size() == samples.size());
        for (size_t i = 0; i < samples.size(); i++)
            REQUIRE(std::abs(picture.bytes[i] - samples[i]) <= 10); // of lossy compression
        const Picture grey = read(jpeg_of(40, 24, JCS_GRAYSCALE, Bytes(40 * 24, 77), progressive));
        CHECK(grey.channels == 1);
        CHECK(bytes_of(grey) == Bytes(40 * 24, 77));
        for (const size_t left : {file.size() / 8, file.size() / 2, file.size() - 20}) {
            INFO(left << " of " << file.size() << (progressive ? ", progressive" : ""));
            CHECK_THAT(error_in(file.substr(0, left)), Catch::StartsWith("cannot be read as JPEG: "));
        }
    }
    CHECK_THAT(error_in(jpeg_of(8, 8, JCS_CMYK, Bytes(4 * 64, 99))), Catch::Contains("CMYK"));
}

TEST_CASE_METHOD(PictureFixture, "Radiance HDR: flat, old and new runs, the middle of steps", "[picture]") {
    const std::string pixel = "\x80\x40\x20\x81", black("\0\0\0\x81", 4), none("\x80\x40\x20\0", 4);
    const float red = 128.5f / 128, green = 64.5f / 128, blue = 32.5f / 128;
    const Picture flat = read(hdr_of(3, 1, pixel + black + none));
    CHECK(flat.width == 3);
    CHECK(flat.channels == 3);
    CHECK_FALSE(flat.encoded);
    CHECK(floats_of(flat) == std::vector<float>{red, green, blue, 0, 0, 0, 0, 0, 0});
    const std::string run = "\1\1\1";
    const Picture old_runs = read(hdr_of(1 + 2 + 256, 1, pixel + run + "\x02" + run + "\x01"));
    REQUIRE(old_runs.floats.size() == 3 * 259);
    for (size_t i = 0; i < old_runs.floats.size(); i += 3)
        REQUIRE((old_runs.floats[i] == red && old_runs.floats[i + 1] == green && old_runs.floats[i + 2] == blue));
    // eight pixels: a run, bytes as they are, both, a run
    const std::string line = "\2\2\0\x08"s + "\x88\x80"s + "\x08\x40\x41\x42\x43\x44\x45\x46\x47"s +
                             "\x84\x20\x04\x30\x31\x32\x33"s + "\x88\x81"s;
    const Picture runs = read(hdr_of(8, 2, line + line));
    REQUIRE(runs.floats.size() == 3 * 16);
    CHECK(runs.floats[3 * 15] == red);
    CHECK(runs.floats[3 * 15 + 1] == (0x47 + 0.5f) / 128);
    CHECK(runs.floats[3 * 12 + 2] == (0x30 + 0.5f) / 128);
    CHECK(read("#?RGBE\n\n-Y 1 +X 1\n" + pixel).floats.size() == 3);
    CHECK(read(hdr_start.substr(0, hdr_start.size() - 1) + "EXPOSURE=4\n\n-Y 1 +X 1\n" + pixel).floats[0] == red);

    CHECK_THAT(error_in("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + pixel),
               Catch::Contains("32-bit_rle_xyze"));
    for (const char *size :
         {"+Y 1 +X 1", "-Y 1 -X 1", "+X 1 -Y 1", "-Y 0 +X 1", "-Y 1", "-Y 1x +X 1", "-Y 9999999999 +X 1"})
        CHECK_THAT(error_in(hdr_start + size + "\n" + pixel), Catch::Contains(fmt::format("its size is '{}'", size)));
    CHECK_THAT(error_in("#?RADIANCE\nFORMAT=32-bit_rle_rgbe"), Catch::Contains("its header does not end"));
    CHECK_THAT(error_in(hdr_of(2, 1, run + "\1" + pixel)), Catch::Contains("no pixel before it"));
    CHECK_THAT(error_in(hdr_of(2, 1, pixel + run + "\2")), Catch::Contains("a run passes the end of its line"));
    CHECK_THAT(error_in(hdr_of(8, 1, "\2\2\0\x08\x89"s + std::string(40, 1))), Catch::Contains("passes the end"));
    CHECK_THAT(error_in(hdr_of(8, 1, "\2\2\0\x08\0\0"s + std::string(40, 1))), Catch::Contains("a run has no pixels"));
    CHECK_THAT(error_in(hdr_of(8, 1, "\2\2\0\x09"s + std::string(40, 1))), Catch::Contains("not as wide as the image"));
}

TEST_CASE_METHOD(PictureFixture, "OpenEXR: parts, layers, tiles, halves, one channel", "[picture]") {
    const std::filesystem::path file = scratch / "a.exr";
    const std::vector<float> r = {1, 2, 3, 4, 5, 6}, g = {7, 8, 9, 10, 11, 12}, b = {0.5, 1.5, 2.5, 3.5, 4.5, 5.5};
    const std::vector<float> all = {1, 7, 0.5, 2, 8, 1.5, 3, 9, 2.5, 4, 10, 3.5, 5, 11, 4.5, 6, 12, 5.5};
    const auto read_parts = [&](const std::vector<Part> &parts, bool tiled = false, int first = 0) {
        write_parts(file, 3, parts, tiled, first);
        const Picture picture = read_picture(file);
        CHECK(picture.width == 3);
        CHECK(picture.height == 2);
        CHECK_FALSE(picture.encoded);
        return picture;
    };
    const std::vector<float> other(6, 99);
    for (const Imf::PixelType type : {Imf::FLOAT, Imf::HALF})
        for (const bool tiled : {false, true})
            CHECK(floats_of(read_parts({{"x", {{"R", r, type}, {"G", g, type}, {"B", b, type}}}}, tiled)) == all);
    CHECK(floats_of(read_parts({{"x", {{"A", other}, {"R", r}, {"G", g}, {"B", b}, {"albedo.R", other}}}})) == all);
    CHECK(floats_of(read_parts({{"variance", {{"R", other}, {"G", other}, {"B", other}}},
                                {"rgb", {{"R", r}, {"G", g}, {"B", b}}}})) == all);
    CHECK(floats_of(read_parts({{"x", {{"r", r}, {"g", g}, {"b", b}}}})) == all);
    CHECK(floats_of(read_parts({{"x", {{"R", r}, {"G", g}, {"B", b}}}}, false, 4)) == all);
    for (const char *name : {"Y", "height"}) {
        const Picture grey = read_parts({{"x", {{name, r}}}});
        CHECK(grey.channels == 1);
        CHECK(floats_of(grey) == r);
    }
    write_parts(file, 3, {{"x", {{"variance.R", r}, {"variance.G", g}}}});
    CHECK_THAT(error_in(test::read_text(file)), Catch::Contains("no channels R, G, B; it has variance.G, variance.R"));

    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const size_t before = warnings().size();
    const Picture invalid = read_parts({{"x", {{"Y", {nan, infinity, -1, -2, 3, 0.5}}}}});
    CHECK(floats_of(invalid) == std::vector<float>{0, 0, -1, -2, 3, 0.5});
    CHECK(invalid.negative == 2);
    CHECK(invalid.above_one == 1);
    REQUIRE(warnings().size() == before + 1);
    CHECK(warnings().back() == file.string() + ": 2 values are NaN or infinite: they are taken as 0");

    Imf::Header header(3, 2);
    header.channels().insert("R", Imf::Channel(Imf::FLOAT));
    header.setType(Imf::DEEPSCANLINE);
    header.compression() = Imf::ZIPS_COMPRESSION;
    { const Imf::DeepScanLineOutputFile deep(file.c_str(), header); }
    CHECK_THAT(error_in(test::read_text(file)), Catch::Contains("it is deep"));
}

TEST_CASE_METHOD(PictureFixture, "A picture that is cut off is an error, wherever it ends", "[picture]") {
    write_parts(scratch / "a.exr", 3, {{"x", {{"Y", {1, 2, 3, 4, 5, 6}}}}});
    const std::string deep_png = png_of({9, 5, 16, PNG_COLOR_TYPE_GRAY, Bytes(2 * 9 * 5, 50), true});
    for (const std::string &file : {png_of({5, 3, 8, PNG_COLOR_TYPE_RGB, ramps(5, 3)}), deep_png,
                                    jpeg_of(20, 9, JCS_RGB, ramps(20, 9)), jpeg_of(20, 9, JCS_RGB, ramps(20, 9), true),
                                    hdr_of(3, 2, std::string(24, 60)), test::read_text(scratch / "a.exr")}) {
        REQUIRE(error_in(file) == "");
        for (size_t left = 1; left + 2 < file.size(); left++) { // without the end mark of JPEG nothing is lost
            INFO(left << " of " << file.size() << " bytes of " << file.substr(0, 4));
            REQUIRE(error_in(file.substr(0, left)) != "");
        }
    }
}

TEST_CASE_METHOD(PictureFixture, "Sizes that so few bytes cannot hold are refused by the header", "[picture]") {
    CHECK_THAT(error_in(png_of({60000, 60000, 8, PNG_COLOR_TYPE_RGB, {}})),
               Catch::EndsWith("bytes cannot hold 60000 x 60000 pixels"));
    std::string jpeg = jpeg_of(8, 8, JCS_GRAYSCALE, Bytes(64, 9));
    const size_t frame = jpeg.find("\xff\xc0");
    REQUIRE(frame != jpeg.npos);
    jpeg.replace(frame + 5, 4, "\xea\x60\xea\x60"); // height and width
    CHECK_THAT(error_in(jpeg), Catch::EndsWith("bytes cannot hold 60000 x 60000 pixels"));
    CHECK_THAT(error_in(hdr_of(60000, 60000, "\x80\x40\x20\x81")), Catch::EndsWith("cannot hold 60000 x 60000 pixels"));
    // so much can be held
    CHECK(read(png_of({1000, 400, 1, PNG_COLOR_TYPE_GRAY, Bytes(125 * 400, 0)})).bytes.size() == 400000);
    CHECK(read(jpeg_of(2000, 2000, JCS_GRAYSCALE, Bytes(4000000, 0), true)).bytes.size() == 4000000);
}

TEST_CASE_METHOD(PictureFixture, "The kind of a picture is told by its bytes", "[picture]") {
    const std::string jpeg = jpeg_of(8, 8, JCS_GRAYSCALE, Bytes(64, 77));
    CHECK(bytes_of(read(jpeg, "a.png")) == Bytes(64, 77));
    const auto of_kind = [](const std::string &kind) {
        return Catch::StartsWith("is " + kind + ", not an image that Opal reads (PNG, JPEG, Radiance HDR, OpenEXR)");
    };
    CHECK_THAT(error_in("GIF89a......"), of_kind("a GIF image") && Catch::Contains("magick "));
    CHECK_THAT(error_in("BM\x36\0\0\0\0\0\0\0\x36"s), of_kind("a BMP image"));
    CHECK_THAT(error_in("RIFF\x10\0\0\0WEBPVP8 "s), of_kind("a WebP image"));
    CHECK_THAT(error_in("II*\0\x08"s), of_kind("a TIFF image") && Catch::EndsWith("-o NEW.exr"));
    CHECK_THAT(error_in("DDS |"), of_kind("a DDS image"));
    CHECK_THAT(error_in("PF\n1 1\n-1.0\n"), of_kind("a PFM image"));
    CHECK_THAT(error_in("\0\0\x02"s + std::string(40, '\0') + "TRUEVISION-XFILE.\0"s), of_kind("a TGA image"));
    CHECK_THAT(error_in("\0\0\0\x1c"
                        "ftypavif"s),
               of_kind("an AVIF image"));
    CHECK_THAT(error_in("<svg xmlns='a'/>"), of_kind("an SVG drawing"));
    CHECK_THAT(error_in("\1\2\3\0\4"s), of_kind("a binary file"));
    CHECK_THAT(error_in("hello"), of_kind("a file of unknown kind"));
    CHECK_THAT(error_in(""), of_kind("a file of unknown kind"));
}

TEST_CASE_METHOD(PictureFixture, "A loader decodes each file once, and tells errors in their order", "[picture]") {
    const Bytes many = ramps(700, 600); // large enough for a thread of its own
    const std::string good = png_of({700, 600, 8, PNG_COLOR_TYPE_RGB, many});
    scratch.write("a.png", good);
    scratch.write("b.png", png_of({2, 1, 8, PNG_COLOR_TYPE_GRAY, {1, 2}}));
    scratch.write("cut.png", good.substr(0, good.size() / 2));
    std::filesystem::create_symlink("a.png", scratch / "link.png");
    FileHashes hashes, both;
    std::vector<std::string> errors;
    const auto on_error = [&](const std::string &error) { errors.push_back(error); };
    PictureLoader loader;
    const auto a = loader.load(scratch / "a.png", &hashes, on_error);
    CHECK(a->width == 700);
    CHECK(loader.load(scratch.path() / "." / "a.png", &hashes, on_error) == a);
    CHECK(loader.load(scratch / "link.png", &hashes, on_error) == a);
    const auto cut = loader.load(scratch / "cut.png", &hashes, on_error);
    const auto b = loader.load(scratch / "b.png", &hashes, on_error);
    CHECK_THROWS_AS(loader.load(scratch / "none.png", &hashes, on_error), Error);
    loader.finish();
    CHECK(bytes_of(*a) == many);
    CHECK(bytes_of(*b) == Bytes{1, 2});
    REQUIRE(errors.size() == 1);
    CHECK_THAT(errors[0], Catch::StartsWith((scratch / "cut.png").string() + ": cannot be read as PNG: "));
    CHECK(cut->width == 1);
    CHECK(floats_of(*cut) == std::vector<float>{0.5f});
    for (const char *name : {"a.png", "cut.png", "b.png"})
        both.add(test::read_text(scratch / name));
    CHECK(hashes.value() == both.value());
    CHECK(loader.load_now(scratch / "b.png", &hashes) == b);
    CHECK_THROWS_AS(loader.load_now(scratch / "cut.png", &hashes), Error);
}
