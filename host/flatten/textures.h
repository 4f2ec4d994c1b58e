// Textures as records of the scene's table of words.
#pragma once

#include "base/large_vector.h"
#include "scene/textures.h"
#include "shared/glue.h"

#include <map>
#include <vector>

namespace opal {

// Puts the record of each texture into a table, equal ones once.
class TextureGatherer {
public:
    explicit TextureGatherer(LargeVector<uint> &table) : table_(table) {}
    uint add(const Texture &texture); // returns the first word of its record

private:
    LargeVector<uint> &table_;
    std::map<std::vector<uint>, uint> known_; // first word of each record
};

} // namespace opal
