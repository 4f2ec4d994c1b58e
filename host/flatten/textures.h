// Textures as records of the scene's table of words.
#pragma once

#include "base/large_vector.h"
#include "bvh/bvh.h"
#include "scene/textures.h"
#include "shared/glue.h"

#include <functional>
#include <map>
#include <span>
#include <vector>

namespace opal {

// The mean of a texture over its unit square, as a luminance.
double mean_luminance(const Texture &texture);

// Puts the record of each texture into a table, equal ones once.
class TextureGatherer {
public:
    // attributes: where those of meshes are
    TextureGatherer(LargeVector<uint> &table, std::span<const AttributeRange> attributes)
        : table_(table), attributes_(attributes) {}
    uint add(const Texture &texture); // returns the first word of its record

    // The texels of all textures, to be made once, after the last one was added. free: frees each picture as soon as
    // it is copied; empty if pictures stay.
    LargeVector<uint> texels(const std::function<void(const Picture &)> &free) const;

    uint kinds() const { return kinds_; }               // bit TEXTURE_* of each
    uint bitmap_forms() const { return bitmap_forms_; } // BITMAP_* of all bitmaps

private:
    // How a picture's values become texels.
    enum class Values {
        as_they_are, // bytes, which the device decodes, or floats
        half,        // as half floats
        decoded,     // from sRGB
        decoded_half // both
    };
    struct Stored {
        const Picture *picture;
        Values values;
        bool repeats;      // whether a row's last texel is followed by the first one again, or by itself
        std::size_t first; // word of the texels
    };

    LargeVector<uint> &table_;
    std::span<const AttributeRange> attributes_;
    std::map<std::vector<uint>, uint> known_; // first word of each record
    std::vector<Stored> stored_;
    std::size_t words_ = 0; // of the texels
    uint kinds_ = 0, bitmap_forms_ = 0;

    std::vector<uint> words(const CheckerboardTexture &texture);
    std::vector<uint> words(const BitmapTexture &texture);
    std::vector<uint> words(const MeshAttributeTexture &texture);
    std::size_t place_of(const Picture &picture, Values values, bool repeats);
};

} // namespace opal
