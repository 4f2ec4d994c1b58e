#include "flatten/textures.h"

#include "flatten/store.h"
#include "scene/parameters.h"
#include "textures/list.h"

namespace opal {
namespace {

void store_map(const UvTransform &map, float (&words)[2][3]) {
    for (int row = 0; row < 2; row++)
        for (int column = 0; column < 3; column++)
            words[row][column] = float(map[row][column]);
}

texture_checkerboard_record record_of(const CheckerboardTexture &texture) {
    texture_checkerboard_record record{};
    record.kind = TEXTURE_checkerboard;
    store_map(texture.to_uv, record.to_uv);
    store(texture.color0, 1, record.color0);
    store(texture.color1, 1, record.color1);
    return record;
}

} // namespace

uint TextureGatherer::add(const Texture &texture) {
    const std::vector<uint> words = std::visit([](const auto &own) { return words_of(record_of(own)); }, texture);
    const auto [found, is_new] = known_.try_emplace(words, uint(table_.size()));
    if (is_new)
        table_.insert(table_.end(), words.begin(), words.end());
    return found->second;
}

} // namespace opal
