#include "flatten/textures.h"

#include "base/error.h"
#include "base/srgb.h"
#include "flatten/store.h"
#include "scene/parameters.h"
#include "scene/shapes.h"
#include "shared/types.h"
#include "textures/list.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace opal {
namespace {

void store_map(const UvTransform &map, float (&words)[2][3]) {
    for (int row = 0; row < 2; row++)
        for (int column = 0; column < 3; column++)
            words[row][column] = float(map[row][column]);
}

constexpr uint byte_values = 256;

double mean_of(const CheckerboardTexture &texture) {
    return (luminance(texture.color0) + luminance(texture.color1)) / 2;
}

double mean_of(const BitmapTexture &texture) {
    const Picture &picture = *texture.picture;
    const bool encoded = picture.encoded && !texture.raw;
    const auto linear = [encoded](double value) { return encoded ? srgb_decode(value) : value; };
    const auto channels = std::size_t(picture.channels);
    const std::size_t values = std::max(picture.bytes.size(), picture.floats.size());
    Color sum{};
    for (std::size_t i = 0; i < values; i++) {
        const double value = linear(picture.bytes.empty() ? double(picture.floats[i]) : picture.bytes[i] / 255.0);
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
    const auto [first, decode] = place_of(picture, picture.encoded && !texture.raw);
    texture_bitmap_record record{};
    record.kind = TEXTURE_bitmap;
    store_map(texture.to_uv, record.to_uv);
    record.width = uint(picture.width);
    record.height = uint(picture.height);
    record.channels = uint(picture.channels);
    record.first = first;
    record.decode = decode;
    record.wrap = texture.wrap;
    record.nearest = texture.nearest;
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

// The texels begin with two tables, the values of bytes as numbers and as sRGB means them. Bytes of all pictures follow
// as the files have them, floats are decoded.
TextureGatherer::Place TextureGatherer::place_of(const Picture &picture, bool encoded) {
    if (texels_.empty())
        for (const bool curve : {false, true})
            for (uint byte = 0; byte < byte_values; byte++)
                texels_.push_back(std::bit_cast<uint>(float(curve ? srgb_decode(byte / 255.0) : byte / 255.0)));
    const bool has_bytes = !picture.bytes.empty();
    const auto [found, is_new] = pictures_.try_emplace({&picture, encoded && !has_bytes});
    if (is_new) {
        const std::size_t bytes = has_bytes ? picture.bytes.size() : sizeof(float) * picture.floats.size();
        const std::size_t first = texels_.size();
        if (sizeof(uint) * first + bytes > std::numeric_limits<uint>::max())
            throw Error("the textures have more than 4 GiB of texels together");
        texels_.resize(first + (bytes + sizeof(uint) - 1) / sizeof(uint));
        if (has_bytes) {
            std::memcpy(&texels_[first], picture.bytes.data(), bytes);
        } else {
            for (std::size_t i = 0; i < picture.floats.size(); i++) {
                const float value = picture.floats[i];
                texels_[first + i] = std::bit_cast<uint>(encoded ? float(srgb_decode(value)) : value);
            }
        }
        found->second = {uint(has_bytes ? sizeof(uint) * first : first), OPAL_NONE};
    }
    Place place = found->second;
    if (has_bytes)
        place.decode = encoded ? byte_values : 0;
    return place;
}

uint TextureGatherer::add(const Texture &texture) {
    const std::vector<uint> record = std::visit([this](const auto &own) { return words(own); }, texture);
    const auto [found, is_new] = known_.try_emplace(record, uint(table_.size()));
    if (is_new)
        table_.insert(table_.end(), record.begin(), record.end());
    return found->second;
}

} // namespace opal
