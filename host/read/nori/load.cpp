#include "read/nori/load.h"

#include "base/file_use.h"
#include "base/log.h"
#include "read/nori/names.h"
#include "read/nori/parsers.h"
#include "scene/options.h"

#include <fmt/format.h>

namespace opal {

namespace {

// The default filter, for a scene without <rfilter>.
void choose_filter(SceneDescription &scene) {
    Filter &filter = scene.camera.filter;
    if (filter.given)
        return;
    const bool is_box = scene.dialect == Dialect::course;
    filter.kind = is_box ? FILTER_box : FILTER_gaussian;
    filter.radius = is_box ? 0.5 : 2;
}

// What follows from a dialect for this scene; empty if nothing does.
std::string consequence_of(const SceneDescription &scene) {
    if (scene.dialect == Dialect::course)
        return scene.camera.filter.given ? "" : "without <rfilter> the filter is a box";
    return fmt::format("the camera's +x points to the {} of the image",
                       scene.dialect == Dialect::eth ? "right" : "left");
}

DialectChoice choose_dialect(const XmlNode &scene, const ParseContext &context) {
    return context.dialect ? DialectChoice{*context.dialect, "", ""} : dialect_of(scene);
}

// Says by which name the dialect was told, where something follows from it.
void tell_dialect(const SceneDescription &scene, const DialectChoice &choice, const SourcePlace &place) {
    const std::string dialect = name_of(choice.dialect), consequence = consequence_of(scene);
    if (!choice.against.empty())
        warn(fmt::format("{}: names of several dialects: {}, and {}; it is read as {}{}{}; --dialect decides otherwise",
                         place.text(), choice.reason, choice.against, dialect, consequence.empty() ? "" : ": ",
                         consequence));
    else if (!choice.reason.empty() && !consequence.empty())
        info(fmt::format("dialect {}, by {}: {}; --dialect decides otherwise", dialect, choice.reason, consequence));
    else if (!scene.camera.filter.given)
        info(fmt::format("no <rfilter>: {}, as dialect {} means it",
                         scene.camera.filter.kind == FILTER_box ? "box" : "gaussian", dialect));
}

// Opal's camera has +x to the left of the image.
void turn_camera(SceneDescription &scene) {
    if (scene.dialect == Dialect::eth)
        scene.camera.to_world = scene.camera.to_world * Transform::scale({-1, 1, 1});
}

void warn_if_black(const SceneDescription &scene, const XmlNode &node) {
    if (scene.meshes.empty())
        warn(node.place().text() + ": the scene has no <mesh>; it renders black");
    else if (integrator_of(scene.strategy).has(OPAL_ASKS_LIGHTS) && !has_light(scene))
        warn(node.place().text() + ": the scene has no <emitter>; it renders black");
}

} // namespace

ParseContext context_for(const std::filesystem::path &file, const LoadOptions &options, Mistakes &mistakes) {
    // Names in a scene that comes by /dev/stdin are of the current folder.
    ParseContext context{descriptor_of(file) ? std::filesystem::path() : file.parent_path(), options.lenient,
                         &mistakes};
    context.is_leftover = is_leftover_attribute;
    if (options.dialect != "auto")
        context.dialect = Dialect(&find_row(dialects(), "dialect", options.dialect) - dialects().data());
    return context;
}

SceneDescription parse_scene(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context, false);
    SceneDescription scene;
    scene.file = node.place().file;
    scene.dialect = choose_dialect(node, context).dialect;
    scene.place = scene.sampler_place = node.place();
    apply_integrator(scene.strategy, find_integrator(scene.integrator_type));
    const auto camera = properties.child("camera");
    if (!camera)
        properties.lacks("<scene> lacks its <camera>");
    if (auto integrator = properties.child("integrator"))
        context.attempt(*integrator, [&] { parse_integrator(*integrator, context, scene); });
    if (auto sampler = properties.child("sampler"))
        context.attempt(*sampler, [&] { parse_sampler(*sampler, context, scene); });
    if (camera)
        context.attempt(*camera, [&] { scene.camera = parse_camera(*camera, context); });
    for (const XmlNode &child : properties.children("mesh"))
        context.attempt(child, [&] {
            for (Mesh &mesh : parse_meshes(child, context))
                scene.meshes.push_back(std::move(mesh));
        });
    for (const XmlNode &emitter : properties.children("emitter"))
        context.attempt(emitter, [&] { scene.lights.push_back(parse_scene_emitter(emitter, context)); });
    properties.finish();
    choose_filter(scene);
    turn_camera(scene);
    if (!context.mistakes || context.mistakes->count() == 0)
        warn_if_black(scene, node);
    return scene;
}

SceneDescription load_nori_scene(const std::filesystem::path &file, const LoadOptions &options) {
    FileHashes hashes;
    XmlDocument document(file, &hashes);
    XmlNode root = document.root();
    if (root.tag() == "test")
        root.fail("this is a <test>, not a <scene>: run it with `opal test`");
    if (root.tag() != "scene")
        root.fail(unknown_name("root", root.tag(), {"scene", "test"}));
    Mistakes mistakes;
    ParseContext context = context_for(file, options, mistakes);
    const Definitions definitions = document.define(options.definitions, context.handler());
    mistakes.throw_all(); // what lacks its value would be told twice
    const DialectChoice choice = choose_dialect(root, context);
    context.dialect = choice.dialect; // so that parse_scene does not look for names again
    context.hashes = &hashes;
    SceneDescription scene = parse_scene(root, context);
    scene.definitions = definitions;
    scene.hash = hashes.value();
    mistakes.throw_all();
    tell_dialect(scene, choice, root.place());
    return scene;
}

} // namespace opal
