// Textures as records of the scene's table of words.
#pragma once

#include "base/large_vector.h"
#include "bvh/bvh.h"
#include "scene/textures.h"
#include "shared/glue.h"

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
    TextureGatherer(LargeVector<uint> &table, LargeVector<uint> &texels, std::span<const AttributeRange> attributes)
        : table_(table), texels_(texels), attributes_(attributes) {}
    uint add(const Texture &texture); // returns the first word of its record

private:
    LargeVector<uint> &table_, &texels_;
    std::span<const AttributeRange> attributes_;
    std::map<std::vector<uint>, uint> known_; // first word of each record
    struct Place {
        uint first, decode; // as in a record
    };
    std::map<std::pair<const Picture *, bool>, Place> pictures_; // by whether its values are encoded

    std::vector<uint> words(const CheckerboardTexture &texture);
    std::vector<uint> words(const BitmapTexture &texture);
    std::vector<uint> words(const MeshAttributeTexture &texture);
    Place place_of(const Picture &picture, bool encoded);
};

} // namespace opal
