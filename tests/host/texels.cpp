// Pictures as words of the scene's texels.
#include "flatten/textures.h"
#include "shared/types.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cstring>
#include <memory>

using namespace opal;

namespace {

std::shared_ptr<Picture> picture_of(int width, int channels) {
    const auto picture = std::make_shared<Picture>();
    picture->width = width;
    picture->height = 1;
    picture->channels = channels;
    picture->encoded = true;
    return picture;
}

texture_bitmap_record record_at(const LargeVector<uint> &table, uint at) {
    texture_bitmap_record record;
    std::memcpy(&record, &table[at], sizeof record);
    return record;
}

} // namespace

TEST_CASE("Bytes stay bytes, 16 bits become half floats or floats, each picture is stored once and freed", "[texels]") {
    const auto bytes = picture_of(3, 1), deep = picture_of(2, 1), linear = picture_of(1, 3);
    bytes->bytes = {1, 2, 3};
    deep->floats = {128 / 255.f, 1};
    linear->floats = {-2, 7, 0.1f};
    linear->encoded = false;
    LargeVector<uint> table;
    TextureGatherer gatherer(table, {});
    const BitmapTexture decoded{.picture = bytes}, raw{.picture = bytes, .raw = true};
    const uint first = gatherer.add(decoded), second = gatherer.add(raw), again = gatherer.add(decoded);
    const uint half = gatherer.add(BitmapTexture{.picture = deep});
    const uint raw_half = gatherer.add(BitmapTexture{.picture = deep, .raw = true});
    const uint full = gatherer.add(BitmapTexture{.picture = deep, .full_precision = true});
    const uint floats = gatherer.add(BitmapTexture{.picture = linear});
    CHECK(again == first);
    CHECK(second != first);
    std::vector<const Picture *> freed;
    const LargeVector<uint> texels = gatherer.texels([&](const Picture &picture) { freed.push_back(&picture); });
    CHECK(freed == std::vector<const Picture *>{bytes.get(), deep.get(), linear.get()});
    CHECK(gatherer.texels({}) == texels);

    const auto value = [&](uint word) { return std::bit_cast<float>(texels[word]); };
    const texture_bitmap_record a = record_at(table, first), b = record_at(table, second);
    CHECK(a.first == b.first);
    REQUIRE(a.first % sizeof(uint) == 0);
    CHECK(texels[a.first / sizeof(uint)] == 0x01030201); // a row, and its first texel again
    CHECK(a.form == (BITMAP_REPEAT | BITMAP_BILINEAR | BITMAP_GREY | BITMAP_ENCODED | BITMAP_UNMAPPED));
    CHECK(b.form == (BITMAP_REPEAT | BITMAP_BILINEAR | BITMAP_GREY | BITMAP_BYTES | BITMAP_UNMAPPED));
    for (const auto &[at, mean] : {std::pair(half, 0.2158203), {raw_half, 0.5019531}, {full, 0.2158605}}) { // Mitsuba
        const texture_bitmap_record record = record_at(table, at);
        CHECK((record.form & BITMAP_FLOATS) != 0);
        CHECK(value(record.first) == Approx(mean).margin(1e-7));
        CHECK(value(record.first + 1) == 1);
        CHECK(value(record.first + 2) == value(record.first));
    }
    const texture_bitmap_record c = record_at(table, floats);
    CHECK(value(c.first) == -2);
    CHECK(value(c.first + 2) == 0.1f);
    CHECK(texels.size() == 1 + 3 * 3 + 2 * 3 + 4);
    CHECK(gatherer.kinds() == 1u << TEXTURE_bitmap);
    CHECK(gatherer.bitmap_forms() ==
          (a.form | b.form | record_at(table, half).form | record_at(table, raw_half).form | c.form));
}

TEST_CASE("A row of texels ends with the one that follows: the first where the bitmap repeats, else the last",
          "[texels]") {
    const auto picture = picture_of(2, 3);
    picture->height = 2;
    picture->bytes = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    LargeVector<uint> table;
    TextureGatherer gatherer(table, {});
    std::vector<uint> at;
    for (const uint wrap : {WRAP_repeat, WRAP_mirror, WRAP_clamp})
        at.push_back(gatherer.add(BitmapTexture{.picture = picture, .wrap = wrap}));
    const LargeVector<uint> texels = gatherer.texels({});
    const auto bytes_of = [&](uint record) {
        std::vector<unsigned char> bytes(18);
        std::memcpy(bytes.data(), reinterpret_cast<const char *>(texels.data()) + record_at(table, record).first, 18);
        return bytes;
    };
    CHECK(bytes_of(at[0]) == std::vector<unsigned char>{1, 2, 3, 4, 5, 6, 1, 2, 3, 7, 8, 9, 10, 11, 12, 7, 8, 9});
    CHECK(bytes_of(at[1]) == std::vector<unsigned char>{1, 2, 3, 4, 5, 6, 4, 5, 6, 7, 8, 9, 10, 11, 12, 10, 11, 12});
    CHECK(record_at(table, at[1]).first == record_at(table, at[2]).first);
}
