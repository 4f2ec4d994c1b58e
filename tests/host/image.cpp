// Images and their files: reading returns what was written; a failed write is an error and leaves no file.
#include "base/error.h"
#include "image/metrics.h"
#include "support/scratch.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <catch2/catch.hpp>
#include <png.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace opal;
using opal::test::ScratchFolder;

namespace {

Image gradient(int width, int height) {
    Image image;
    image.width = width;
    image.height = height;
    for (const char *name : {"R", "G", "B", "variance.R"}) {
        Layer layer{name, {}};
        for (int i = 0; i < width * height; ++i)
            layer.values.push_back(static_cast<float>(image.layers.size()) + 0.1f * static_cast<float>(i));
        image.layers.push_back(layer);
    }
    return image;
}

Image grey(const std::vector<float> &values) {
    Image image;
    image.width = static_cast<int>(values.size());
    image.height = 1;
    image.layers = {{"R", values}, {"G", values}, {"B", values}};
    return image;
}

size_t files_in(const std::filesystem::path &folder) {
    const std::filesystem::directory_iterator begin(folder);
    return static_cast<size_t>(std::distance(begin, std::filesystem::directory_iterator()));
}

std::vector<png_byte> read_png(const std::filesystem::path &file, png_image &header) {
    std::memset(&header, 0, sizeof header);
    header.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_file(&header, file.c_str()));
    CHECK(header.format == PNG_FORMAT_RGB);
    std::vector<png_byte> bytes(PNG_IMAGE_SIZE(header));
    REQUIRE(png_image_finish_read(&header, nullptr, bytes.data(), 0, nullptr));
    return bytes;
}

} // namespace

TEST_CASE("An EXR keeps every bit of every layer and its metadata", "[image]") {
    const ScratchFolder folder;
    Image image = gradient(7, 3);
    image.layers[0].values[0] = std::numeric_limits<float>::infinity();
    image.layers[1].values[1] = std::numeric_limits<float>::denorm_min();
    image.layers[2].values[2] = std::nanf("");
    image.metadata = {{"scene", "a b.xml"}, {"strategy", "{\"mis\": \"power\"}"}, {"empty", ""}};
    write_exr(image, folder / "image.exr");
    const Image read = read_exr(folder / "image.exr");
    CHECK(read.width == 7);
    CHECK(read.height == 3);
    REQUIRE(read.layers.size() == image.layers.size());
    for (const Layer &layer : image.layers)
        CHECK(std::memcmp(read.get(layer.name).values.data(), layer.values.data(),
                          layer.values.size() * sizeof(float)) == 0);
    for (const auto &[name, value] : image.metadata)
        CHECK(read.metadata.at(name) == value);
    CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("The header of an EXR has the form that most programs read right", "[image]") {
    const ScratchFolder folder;
    Image image = gradient(5, 40);
    image.metadata = {{"whole", 7}, {"number", 0.5f}, {"text", "7"}};
    image.crop = {3, 4, 5, 40, 20, 50};
    write_exr(image, folder / "image.exr");
    const Image read = read_exr(folder / "image.exr");
    CHECK(read.metadata.at("whole") == Attribute(7));
    CHECK(read.metadata.at("number") == Attribute(0.5f));
    CHECK(read.metadata.at("text") == Attribute("7"));
    CHECK(read.number("number") == 0.5);
    CHECK(read.text("whole") == "7");
    CHECK(read.crop == image.crop);
    Imf::InputFile file((folder / "image.exr").c_str());
    const Imf::Header &header = file.header();
    CHECK(header.compression() == Imf::ZIPS_COMPRESSION);
    CHECK(header.dataWindow() == Imath::Box2i({0, 0}, {4, 39}));
    CHECK(header.displayWindow() == header.dataWindow());
    CHECK(header.typedAttribute<Imf::StringAttribute>("colorInteropID").value() == "lin_rec709_scene");
    CHECK(header.typedAttribute<Imf::StringAttribute>("software").value() == "Opal " OPAL_VERSION);
    CHECK(Imf::chromaticities(header).red == Imath::V2f(0.64f, 0.33f));
    image.layers.push_back(image.layers[0]);
    image.layers.back().name = "albedo.R";
    CHECK_THROWS_AS(write_exr(image, folder / "image.exr"), std::logic_error);
}

TEST_CASE("The picture is found in files of other programs", "[image]") {
    const ScratchFolder folder;
    const auto read_as = [&](const std::vector<std::string> &names) {
        Image image = gradient(3, 2);
        image.layers.resize(names.size());
        for (size_t i = 0; i < names.size(); i++)
            image.layers[i].name = names[i];
        write_exr(image, folder / "image.exr");
        return read_exr(folder / "image.exr");
    };
    const Image plain = gradient(3, 2);
    for (const auto &names : {std::vector<std::string>{"R", "G", "B", "A"},
                              {"r", "g", "b"},
                              {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"}}) {
        const Image read = read_as(names);
        for (const char *name : {"R", "G", "B"})
            CHECK(read.get(name).values == plain.get(name).values);
    }
    const Image grey = read_as({"Y"});
    for (const char *name : {"R", "G", "B"})
        CHECK(grey.get(name).values == plain.get("R").values);
    CHECK_FALSE(read_as({"Z"}).find("R"));

    // Two parts, the picture second; and a data window within the display window.
    std::vector<Imf::Header> headers(2, Imf::Header(Imath::Box2i({0, 0}, {9, 9}), Imath::Box2i({4, 5}, {6, 6})));
    std::vector<float> values(6, 2.5f);
    for (Imf::Header &header : headers) {
        const bool picture = &header == &headers[1];
        header.setType(Imf::SCANLINEIMAGE);
        header.setName(picture ? "Combined" : "variance");
        for (const char *name : {"R", "G", "B"})
            header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    {
        Imf::MultiPartOutputFile file((folder / "parts.exr").c_str(), headers.data(), 2);
        for (int part = 0; part < 2; part++) {
            Imf::FrameBuffer frame;
            std::fill(values.begin(), values.end(), part ? 2.5f : 0.f);
            for (const char *name : {"R", "G", "B"})
                frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), headers[0].dataWindow()));
            Imf::OutputPart output(file, part);
            output.setFrameBuffer(frame);
            output.writePixels(2);
        }
    }
    const Image read = read_exr(folder / "parts.exr");
    CHECK(read.get("G").values == std::vector<float>(6, 2.5f));
    CHECK(read.crop == Crop{4, 5, 3, 2, 10, 10});
}

TEST_CASE("An EXR of repetitions is the file that OpenEXR writes, one of noise has its pixels", "[image]") {
    const ScratchFolder folder;
    std::mt19937 random(1);
    const auto bits = [&] { return std::bit_cast<float>(uint32_t(random())); };
    for (const auto &[width, height] : {std::pair{1, 1}, {31, 33}, {200, 97}})
        for (const bool noise : {false, true}) {
            INFO(width << " x " << height << ", noise " << noise);
            Image image = gradient(width, height);
            image.layers[3].name = "variance.with_a_name_of_more_than_31_letters";
            image.metadata = {{"scene", "a b.xml"}};
            float repeated[5];
            std::generate_n(repeated, 5, bits);
            for (Layer &layer : image.layers)
                for (size_t i = 0; i < layer.values.size(); i++)
                    layer.values[i] = noise ? bits() : repeated[i % 5];
            write_exr(image, folder / "ours.exr");
            const Image read = read_exr(folder / "ours.exr");
            for (const Layer &layer : image.layers)
                CHECK(std::memcmp(read.get(layer.name).values.data(), layer.values.data(),
                                  layer.values.size() * sizeof(float)) == 0);
            {
                Imf::InputFile ours((folder / "ours.exr").c_str());
                Imf::OutputFile theirs((folder / "theirs.exr").c_str(), ours.header());
                Imf::FrameBuffer frame;
                for (Layer &layer : image.layers)
                    frame.insert(layer.name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(layer.values.data()),
                                                        sizeof(float), sizeof(float) * size_t(width)));
                theirs.setFrameBuffer(frame);
                theirs.writePixels(height);
            }
            const std::string own = test::read_text(folder / "ours.exr"),
                              other = test::read_text(folder / "theirs.exr");
            if (noise) // its chunks may be packed otherwise
                CHECK(double(own.size()) < 1.03 * double(other.size()));
            else
                CHECK((own == other));
        }
}

TEST_CASE("A file that is no EXR, or only a part of one, is refused by name", "[image]") {
    const ScratchFolder folder;
    CHECK_THROWS_WITH(read_exr(folder / "none.exr"), Catch::Contains("none.exr"));
    folder.write("text.exr", "this is a text");
    CHECK_THROWS_WITH(read_exr(folder / "text.exr"), Catch::Contains("text.exr: cannot be read as OpenEXR"));
    write_exr(gradient(64, 64), folder / "whole.exr");
    const std::string bytes = test::read_text(folder / "whole.exr");
    folder.write("half.exr", bytes.substr(0, bytes.size() / 2));
    CHECK_THROWS_AS(read_exr(folder / "half.exr"), Error);
}

TEST_CASE("An EXR that states larger attributes or images than it can hold takes no memory for them", "[image]") {
    const ScratchFolder folder;
    write_exr(gradient(4, 2), folder / "whole.exr");
    const std::string bytes = test::read_text(folder / "whole.exr");
    // The file with another number of 32 bits behind that text and `skipped` bytes.
    const auto with_number = [&](const std::string &text, size_t skipped, int32_t number) {
        std::string changed = bytes;
        const size_t at = bytes.find(text);
        REQUIRE(at != bytes.npos);
        std::memcpy(&changed[at + text.size() + skipped], &number, sizeof number);
        return folder.write("changed.exr", changed);
    };
    using namespace std::literals;
    const auto file = with_number("software\0string\0"s, 0, 100000);
    CHECK_THROWS_WITH(read_exr(file), Catch::Contains("an attribute is larger than the file"));
    with_number("dataWindow\0box2i\0"s, sizeof(int32_t) + 2 * sizeof(int32_t), 1 << 24); // its right end
    CHECK_THROWS_WITH(read_exr(file), Catch::Contains("bytes cannot hold 16777217 x 2 pixels"));
}

TEST_CASE("A missing layer is named with those that there are", "[image]") {
    CHECK_THROWS_WITH(gradient(1, 1).get("albedo"), "the image has no layer 'albedo'; available: R, G, B, variance.R");
}

TEST_CASE("A PNG has the exact sRGB curve, rounded, and magenta for what is not finite", "[image]") {
    const ScratchFolder folder;
    const float infinity = std::numeric_limits<float>::infinity();
    // 0.5 -> 0.735357 * 255 = 187.5 ..., 0.0031308 -> 0.04045 * 255 = 10.3, 0.2158605 is display value 0.5 -> 127.5
    write_png(grey({-1, 0, 0.0031308f, 0.18f, 0.5f, 1, 7, infinity}), folder / "image.png");
    png_image header;
    const std::vector<png_byte> bytes = read_png(folder / "image.png", header);
    REQUIRE(header.width == 8);
    std::vector<int> red, green;
    for (size_t i = 0; i < 8; ++i) {
        red.push_back(bytes[3 * i]);
        green.push_back(bytes[3 * i + 1]);
    }
    CHECK(red == std::vector<int>{0, 0, 10, 118, 188, 255, 255, 255});
    CHECK(green == std::vector<int>{0, 0, 10, 118, 188, 255, 255, 0});
}

TEST_CASE("Exposure and tone mapping come before the sRGB curve", "[image]") {
    const ScratchFolder folder;
    png_image header;
    const auto red_of = [&](const Display &display) {
        write_png(grey({0, 0.045f, 0.25f, 1, -1, std::numeric_limits<float>::max()}), folder / "image.png", display);
        const std::vector<png_byte> bytes = read_png(folder / "image.png", header);
        std::vector<int> red;
        for (size_t i = 0; i < 6; ++i)
            red.push_back(bytes[3 * i]);
        return red;
    };
    // +2 EV: 0.18 -> 118 as without exposure, and 1.
    CHECK(red_of({.exposure = 2}) == std::vector<int>{0, 118, 255, 255, 0, 255});
    // 0.18 -> 0.26690, and 1 -> 0.80380, by the formula; -> 0.55346 and 0.90823 by the sRGB curve.
    CHECK(red_of({.exposure = 2, .tonemap = Tonemap::aces}) == std::vector<int>{0, 141, 232, 252, 0, 255});
}

TEST_CASE("A PNG's bytes are those of the exact curve on both sides of each limit", "[image]") {
    const ScratchFolder folder;
    for (const Display &display : {Display{}, Display{.exposure = 1.3}, Display{.exposure = -60},
                                   Display{.exposure = 0.5, .tonemap = Tonemap::aces}}) {
        INFO("exposure " << display.exposure << ", aces " << (display.tonemap == Tonemap::aces));
        const auto exact = [&](float value) {
            double x = std::exp2(display.exposure) * double(value);
            if (display.tonemap == Tonemap::aces) {
                x = std::max(x, 0.0);
                x = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
            }
            return int(std::floor(255 * srgb_encode(x) + 0.5));
        };
        std::vector<float> values = {0.f, -0.f, 1e-45f, -1e-45f, -1.f, 1.f, 1e30f, -3e38f};
        for (int byte = 1; byte < 256; byte++) { // the limit by bisection of the exact curve, and its neighbours
            float below = 0, above = 1e30f;
            while (std::nextafter(below, above) < above) {
                const float middle = below + (above - below) / 2;
                (exact(middle) < byte ? below : above) = middle;
            }
            REQUIRE((exact(below) < byte && exact(above) >= byte));
            float value = below;
            for (int step = 0; step < 20; step++)
                values.push_back(value = std::nextafter(value, 0.f));
            value = below;
            for (int step = 0; step < 20; step++, value = std::nextafter(value, above + 1))
                values.push_back(value);
        }
        std::mt19937 random(2);
        while (values.size() < 40000) {
            const auto value = std::bit_cast<float>(uint32_t(random()));
            values.push_back(std::isfinite(value) ? value : 0.25f);
        }
        write_png(grey(values), folder / "image.png", display);
        png_image header;
        const std::vector<png_byte> bytes = read_png(folder / "image.png", header);
        size_t wrong = 0;
        for (size_t i = 0; i < values.size(); i++)
            wrong += bytes[3 * i] != exact(values[i]) || bytes[3 * i + 2] != exact(values[i]);
        CHECK(wrong == 0);
    }
}

TEST_CASE("A PNG of noise has its pixels, row by row, and one of repetitions stays small", "[image]") {
    const ScratchFolder folder;
    std::mt19937 random(3);
    for (const bool noise : {false, true}) {
        Image image{150, 60, {}, {}};
        for (const char *name : {"R", "G", "B"}) {
            image.layers.push_back({name, {}});
            for (int i = 0; i < image.width * image.height; i++)
                image.layers.back().values.push_back(noise ? float(random() >> 8) * 0x1p-24f : float(i % 7) / 7);
        }
        write_png(image, folder / "image.png");
        png_image header;
        const std::vector<png_byte> bytes = read_png(folder / "image.png", header);
        REQUIRE((header.width == 150 && header.height == 60));
        bool same = true;
        for (size_t i = 0; i < bytes.size(); i++)
            same = same && bytes[i] == std::floor(255 * srgb_encode(double(image.layers[i % 3].values[i / 3])) + 0.5);
        CHECK(same);
        CHECK(std::filesystem::file_size(folder / "image.png") < (noise ? 1.01 : 0.1) * double(bytes.size()));
    }
}

TEST_CASE("The sRGB curve joins its two pieces", "[image]") {
    CHECK(srgb_encode(0.0031308) == Approx(0.0404499).epsilon(1e-5));
    CHECK(srgb_encode(0.00313081) == Approx(0.0404499).epsilon(1e-5));
    CHECK(srgb_encode(0.21404114) == Approx(0.5).epsilon(1e-7));
}

TEST_CASE("What cannot be written is said before rendering, and nothing is left behind", "[image]") {
    const ScratchFolder folder;
    CHECK_THROWS_WITH(check_writable(folder / "none/a.exr"),
                      Catch::Contains("there is no folder " + (folder / "none").string()));
    folder.write("file", "");
    CHECK_THROWS_WITH(check_writable(folder / "file/a.exr"), Catch::Contains("is not a folder"));
    CHECK_THROWS_WITH(check_writable(folder.path()), Catch::Contains("is a folder"));
    CHECK_NOTHROW(check_writable(folder / "a.exr"));
    CHECK(files_in(folder.path()) == 1);
    if (geteuid() == 0) {
        WARN("root may write everywhere: a read-only folder is not tried");
        return;
    }
    chmod(folder.path().c_str(), 0500);
    CHECK_THROWS_WITH(check_writable(folder / "a.exr"), Catch::Contains("Permission denied"));
    chmod(folder.path().c_str(), 0700);
}

TEST_CASE("A full device is noticed", "[image]") {
    CHECK_THROWS_WITH(write_safely("/dev/full", "text"), "/dev/full: cannot be written: No space left on device");
}

TEST_CASE("A full disk leaves the old file and no other", "[image]") {
    const ScratchFolder folder;
    if (mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0) {
        WARN("a small file system cannot be mounted here: a full disk is not tried");
        return;
    }
    write_safely(folder / "image.exr", "old");
    Image noise = gradient(200, 200);
    for (size_t i = 0; i < noise.layers[0].values.size(); ++i) // does not compress
        noise.layers[0].values[i] = std::sin(1e6f * static_cast<float>(i * i));
    CHECK_THROWS_WITH(write_exr(noise, folder / "image.exr"),
                      Catch::Contains("image.exr: cannot be written: No space left on device"));
    CHECK(test::read_text(folder / "image.exr") == "old");
    CHECK(files_in(folder.path()) == 1);
    umount(folder.path().c_str());
}

TEST_CASE("A link is written through", "[image]") {
    const ScratchFolder folder;
    folder.write("target", "old");
    std::filesystem::create_symlink(folder / "target", folder / "link");
    write_safely(folder / "link", "new");
    CHECK(std::filesystem::is_symlink(folder / "link"));
    CHECK(test::read_text(folder / "target") == "new");
}

TEST_CASE("Metrics of images worked out by hand", "[image]") {
    const Image reference = grey({1, 3}), image = grey({2, 3});
    const Metrics m = compare_images(image, reference);
    CHECK(m.mse == Approx(0.5));
    CHECK(m.rmse == Approx(std::sqrt(0.5)));
    CHECK(m.rel_mse_floor == Approx(0.0004)); // (1 % of 2)^2
    CHECK(m.rel_mse == Approx(0.5 / 1.0004));
    CHECK(m.mae == Approx(0.5));
    CHECK(m.smape == Approx(0.5 * 2.0 / 3));
    CHECK(m.mean_difference == Approx(0.5));
    CHECK(m.max_difference == Approx(1));
    CHECK(m.max_x == 0);
    CHECK(std::isinf(m.psnr)); // both are white when tone-mapped
    CHECK(compare_images(grey({0.21404114f}), grey({0})).psnr == Approx(-20 * std::log10(0.5)).epsilon(1e-6));
}

TEST_CASE("Pixels that are not finite are counted and left out", "[image]") {
    const Metrics m = compare_images(grey({std::nanf(""), 2}), grey({1, 1}));
    CHECK(m.invalid == 1);
    CHECK(m.mse == Approx(1));
    CHECK_THROWS_WITH(compare_images(grey({1}), grey({1, 2})), Catch::Contains("1 x 1 and 2 x 1"));
    CHECK_THROWS_AS(compare_images(grey({std::nanf("")}), grey({1})), Error);
}
