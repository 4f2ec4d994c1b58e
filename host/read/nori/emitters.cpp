// Parsers of emitters. Area lights are children of a mesh, point lights of the scene.
#include "read/nori/parsers.h"

#include <algorithm>

namespace opal {

namespace {

Color emitted(Properties &properties, const std::string &name) {
    Color color = properties.required(properties.color(name), name);
    properties.check(*std::min_element(color.begin(), color.end()) >= 0, name, "must not be negative");
    return color;
}

struct EmitterType {
    std::string name;
    bool of_mesh; // a child of a mesh; false: of the scene
};

// parallelogram_emitter: the 2022 course's name for the area light of a parallelogram.
const std::vector<EmitterType> emitter_types = {{"area", true}, {"parallelogram_emitter", true}, {"point", false}};

void require_parent(const XmlNode &node, bool in_mesh) {
    const EmitterType &type = row_of_type(node, emitter_types);
    if (type.of_mesh != in_mesh)
        node.fail("emitter '" + type.name + "' must stand in a <" + (type.of_mesh ? "mesh" : "scene") +
                  ">, not in a <" + (in_mesh ? "mesh" : "scene") + ">");
}

} // namespace

Color parse_area_emitter(const XmlNode &node, const ParseContext &context) {
    require_parent(node, true);
    Properties properties(node, context);
    Color radiance = emitted(properties, "radiance");
    properties.finish();
    return radiance;
}

PointLight parse_scene_emitter(const XmlNode &node, const ParseContext &context) {
    require_parent(node, false);
    Properties properties(node, context);
    PointLight light;
    light.place = node.place();
    light.position = properties.required(properties.point("position"), "position");
    light.power = emitted(properties, "power");
    properties.finish();
    return light;
}

} // namespace opal
