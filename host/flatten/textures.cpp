#include "flatten/textures.h"

#include "base/error.h"
#include "base/srgb.h"
#include "flatten/store.h"
#include "scene/parameters.h"
#include "scene/shapes.h"
#include "shared/types.h"
#include "textures/list.h"

#include <half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace opal {
namespace {

void store_map(const UvTransform &map, float (&words)[2][3]) {
    for (int row = 0; row < 2; row++)
        for (int column = 0; column < 3; column++)
            words[row][column] = float(map[row][column]);
}

double mean_of(const CheckerboardTexture &texture) {
    return (luminance(texture.color0) + luminance(texture.color1)) / 2;
}

double mean_of(const BitmapTexture &texture) {
    const Picture &picture = *texture.picture;
    const bool encoded = picture.encoded && !texture.raw;
    const auto &bytes = decoded_bytes(encoded);
    const auto channels = std::size_t(picture.channels);
    const std::size_t values = std::max(picture.bytes.size(), picture.floats.size());
    Color sum{};
    for (std::size_t i = 0; i < values; i++) {
        const double value = !picture.bytes.empty() ? bytes[picture.bytes[i]]
                             : encoded              ? srgb_decode(picture.floats[i])
                                                    : double(picture.floats[i]);
        for (std::size_t c = i % channels; c < 3; c += channels)
            sum[c] += value;
    }
    return luminance(sum) * double(channels) / double(values);
}

double mean_of(const MeshAttributeTexture &texture) {
    const auto &values = texture.attribute->values;
    const auto channels = std::size_t(texture.attribute->channels);
    Color sum{};
    for (std::size_t i = 0; i < values.size(); i++)
        for (std::size_t c = i % channels; c < 3; c += channels)
            sum[c] += double(values[i]);
    return values.empty() ? 0 : texture.scale * luminance(sum) * double(channels) / double(values.size());
}

bool has_bytes(const Picture &picture) { return !picture.bytes.empty(); }

constexpr uint most_of_16_bits = 65535;

std::vector<float> decoded_16_bits(bool encoded, bool is_half) {
    std::vector<float> values(most_of_16_bits + 1);
    for (uint i = 0; i < values.size(); i++) {
        const double value = double(i) / most_of_16_bits;
        values[i] = float(encoded ? srgb_decode(value) : value);
        if (is_half)
            values[i] = Imath::half(values[i]);
    }
    return values;
}

// Adds rows of bytes to words, which they need not fill, and to each row the texel that follows its last one. Has the
// room been reserved, each page is touched once.
void append_rows(const Picture &picture, bool repeats, LargeVector<uint> &words) {
    constexpr std::size_t most = 1 << 20; // a block that stays in the cache between zeros and bytes
    const auto texel = std::size_t(picture.channels), row = texel * std::size_t(picture.width);
    const std::uint8_t *from = picture.bytes.data();
    const std::size_t end = sizeof(uint) * words.size() + (row + texel) * std::size_t(picture.height);
    std::size_t at = sizeof(uint) * words.size();
    for (int y = 0; y < picture.height; y++, from += row, at += row + texel) {
        if (sizeof(uint) * words.size() < at + row + texel) {
            const std::size_t block = std::min(std::max(most, row + texel), end - at);
            words.resize((at + block + sizeof(uint) - 1) / sizeof(uint));
        }
        auto *to = reinterpret_cast<std::uint8_t *>(words.data()) + at;
        std::memcpy(to, from, row);
        std::memcpy(to + row, repeats ? from : from + row - texel, texel);
    }
}

// Likewise floats; word_of gives the word of each.
template <class WordOf>
void append_rows(const Picture &picture, bool repeats, WordOf word_of, LargeVector<uint> &words) {
    const auto texel = std::size_t(picture.channels), row = texel * std::size_t(picture.width);
    const float *from = picture.floats.data();
    for (int y = 0; y < picture.height; y++, from += row) {
        for (std::size_t i = 0; i < row; i++)
            words.push_back(word_of(from[i]));
        for (std::size_t i = 0; i < texel; i++)
            words.push_back(word_of(from[repeats ? i : row - texel + i]));
    }
}

// The kernels read so many words at once, of which the last texels may be fewer.
constexpr std::size_t words_beyond = 4;

uint form_of(const BitmapTexture &texture) {
    const Picture &picture = *texture.picture;
    uint form = texture.wrap == WRAP_repeat   ? BITMAP_REPEAT
                : texture.wrap == WRAP_mirror ? BITMAP_MIRROR
                                              : BITMAP_CLAMP;
    form |= texture.nearest ? BITMAP_NEAREST : BITMAP_BILINEAR;
    form |= picture.channels == 1 ? BITMAP_GREY : BITMAP_RGB;
    form |= !has_bytes(picture) ? BITMAP_FLOATS : picture.encoded && !texture.raw ? BITMAP_ENCODED : BITMAP_BYTES;
    return form | (texture.to_uv == identity_uv ? BITMAP_UNMAPPED : BITMAP_MAPPED);
}

} // namespace

double mean_luminance(const Texture &texture) {
    return std::visit([](const auto &own) { return mean_of(own); }, texture);
}

std::vector<uint> TextureGatherer::words(const CheckerboardTexture &texture) {
    texture_checkerboard_record record{};
    record.kind = TEXTURE_checkerboard;
    store_map(texture.to_uv, record.to_uv);
    store(texture.color0, 1, record.color0);
    store(texture.color1, 1, record.color1);
    return words_of(record);
}

std::vector<uint> TextureGatherer::words(const BitmapTexture &texture) {
    const Picture &picture = *texture.picture;
    const bool encoded = picture.encoded && !texture.raw, is_byte = has_bytes(picture);
    const bool is_half = picture.encoded && !is_byte && !texture.full_precision; // of 16 bits, as Mitsuba holds them
    const std::size_t first = place_of(picture,
                                       is_byte || !encoded ? is_half ? Values::half : Values::as_they_are
                                       : is_half           ? Values::decoded_half
                                                           : Values::decoded,
                                       texture.wrap == WRAP_repeat);
    texture_bitmap_record record{};
    record.kind = TEXTURE_bitmap;
    record.width = uint(picture.width);
    record.height = uint(picture.height);
    record.first = uint(is_byte ? sizeof(uint) * first : first);
    store_map(texture.to_uv, record.to_uv);
    record.form = form_of(texture);
    bitmap_forms_ |= record.form;
    return words_of(record);
}

std::vector<uint> TextureGatherer::words(const MeshAttributeTexture &texture) {
    const auto range = std::ranges::find(attributes_, texture.attribute.get(), &AttributeRange::attribute);
    if (range == attributes_.end())
        throw Error(texture.name + ": a texture of an attribute is on something that is no mesh");
    texture_mesh_attribute_record record{};
    record.kind = TEXTURE_mesh_attribute;
    record.stride = range->stride;
    record.first = uint(range->first) - range->stride * range->triangle;
    record.channels = uint(texture.attribute->channels);
    record.corners = texture.attribute->of_faces ? 1 : 3;
    record.scale = float(texture.scale);
    return words_of(record);
}

// Bytes of all pictures as the files have them, and floats.
std::size_t TextureGatherer::place_of(const Picture &picture, Values values, bool repeats) {
    for (const Stored &known : stored_)
        if (known.picture == &picture && known.values == values && known.repeats == repeats)
            return known.first;
    const std::size_t count =
        std::size_t(picture.channels) * (std::size_t(picture.width) + 1) * std::size_t(picture.height);
    const std::size_t first = words_;
    words_ += has_bytes(picture) ? (count + sizeof(uint) - 1) / sizeof(uint) : count;
    if (sizeof(uint) * (words_ + words_beyond) > std::numeric_limits<uint>::max())
        throw Error("the textures have more than 4 GiB of texels together");
    stored_.push_back({&picture, values, repeats, first});
    return first;
}

LargeVector<uint> TextureGatherer::texels(const std::function<void(const Picture &)> &free) const {
    LargeVector<uint> texels;
    if (stored_.empty())
        return texels;
    texels.reserve(words_ + words_beyond);
    for (auto stored = stored_.begin(); stored != stored_.end(); ++stored) {
        const Picture &picture = *stored->picture;
        if (has_bytes(picture)) {
            append_rows(picture, stored->repeats, texels);
        } else if (stored->values == Values::as_they_are) {
            append_rows(
                picture, stored->repeats, [](float value) { return std::bit_cast<uint>(value); }, texels);
        } else {
            const std::vector<float> decoded =
                decoded_16_bits(stored->values != Values::half, stored->values != Values::decoded);
            const auto word_of = [&](float value) {
                return std::bit_cast<uint>(decoded[std::size_t(std::lround(value * most_of_16_bits))]);
            };
            append_rows(picture, stored->repeats, word_of, texels);
        }
        const bool is_last =
            std::none_of(stored + 1, stored_.end(), [&](const Stored &later) { return later.picture == &picture; });
        if (free && is_last)
            free(picture);
    }
    texels.resize(texels.size() + words_beyond);
    return texels;
}

uint TextureGatherer::add(const Texture &texture) {
    const std::vector<uint> record = std::visit([this](const auto &own) { return words(own); }, texture);
    kinds_ |= 1u << record[0];
    const auto [found, is_new] = known_.try_emplace(record, uint(table_.size()));
    if (is_new)
        table_.insert(table_.end(), record.begin(), record.end());
    return found->second;
}

} // namespace opal
