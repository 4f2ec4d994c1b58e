#include "read/nori/load.h"

#include "base/log.h"
#include "read/nori/parsers.h"
#include "scene/options.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

// The default filter, for a scene without <rfilter>: the 2022 course has a box, Nori a Gaussian of radius 2.
void choose_filter(SceneDescription &scene) {
    Filter &filter = scene.camera.filter;
    if (filter.given)
        return;
    filter.kind = scene.university_dialect ? FILTER_box : FILTER_gaussian;
    filter.radius = scene.university_dialect ? 0.5 : 2;
}

bool has_light(const SceneDescription &scene) {
    return !integrator_of(scene.strategy).has(OPAL_ASKS_LIGHTS) || !scene.lights.empty() ||
           std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh &mesh) { return mesh.radiance; });
}

void warn_if_black(const SceneDescription &scene, const XmlNode &node) {
    if (scene.meshes.empty())
        warn(node.place().text() + ": the scene has no <mesh>; it renders black");
    else if (!has_light(scene))
        warn(node.place().text() + ": the scene has no <emitter>; it renders black");
}

} // namespace

SceneDescription parse_scene(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context, false);
    SceneDescription scene;
    scene.file = node.place().file;
    apply_integrator(scene.strategy, find_integrator(scene.integrator_type));
    auto camera = properties.child("camera");
    if (!camera)
        properties.fail("<scene> lacks its <camera>");
    if (auto integrator = properties.child("integrator"))
        parse_integrator(*integrator, context, scene);
    if (auto sampler = properties.child("sampler"))
        parse_sampler(*sampler, context, scene);
    scene.camera = parse_camera(*camera, context);
    for (const XmlNode &child : properties.children("mesh"))
        for (Mesh &mesh : parse_meshes(child, context))
            scene.meshes.push_back(std::move(mesh));
    for (const XmlNode &emitter : properties.children("emitter"))
        scene.lights.push_back(parse_scene_emitter(emitter, context));
    properties.finish();
    choose_filter(scene);
    warn_if_black(scene, node);
    return scene;
}

SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options) {
    XmlDocument document(file);
    XmlNode root = document.root();
    if (root.tag() == "test")
        root.fail("this is a <test>, not a <scene>: run it with `opal test`");
    if (root.tag() != "scene")
        root.fail(unknown_name("root", root.tag(), {"scene", "test"}));
    SceneDescription scene = parse_scene(root, {file.parent_path(), options.lenient});
    if (!scene.camera.filter.given)
        info(fmt::format("no <rfilter>: {}, as scenes with integrator {} mean it",
                         scene.university_dialect ? "box" : "gaussian", scene.integrator_type));
    return scene;
}

} // namespace opal
