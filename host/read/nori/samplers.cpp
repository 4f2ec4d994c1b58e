// Parser of samplers: the source of random numbers, and the samples a pixel.
#include "read/nori/parsers.h"

namespace opal {

void parse_sampler(const XmlNode &node, const ParseContext &context, SceneDescription &scene) {
    std::span<const Choice> types = axes()[AXIS_sampler].choices;
    Properties properties(node, context);
    if (const Choice *type = properties.row_of_type(types, types.front().name + " stands in for it"))
        scene.strategy[AXIS_sampler] = static_cast<int>(type - types.data());
    const std::optional<int> given = properties.integer("sampleCount");
    const int count = given.value_or(1);
    properties.check(count >= 1, "sampleCount", "must be at least 1 sample per pixel");
    scene.spp = static_cast<unsigned>(count);
    scene.sample_count_given = given.has_value();
    scene.sampler_place = node.place();
    properties.finish();
}

} // namespace opal
