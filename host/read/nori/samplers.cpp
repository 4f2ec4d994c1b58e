// Parser of samplers: the source of random numbers, and the samples a pixel.
#include "read/nori/parsers.h"

namespace opal {

void parse_sampler(const XmlNode &node, const ParseContext &context, SceneDescription &scene) {
    std::span<const Choice> types = axes()[AXIS_sampler].choices;
    Properties properties(node, context);
    if (const Choice *type = properties.row_of_type(types, types.front().name + " stands in for it"))
        scene.strategy[AXIS_sampler] = static_cast<int>(type - types.data());
    int count = properties.integer("sampleCount").value_or(1);
    properties.check(count >= 1, "sampleCount", "must be at least 1 sample per pixel");
    scene.spp = static_cast<unsigned>(count);
    properties.finish();
}

} // namespace opal
