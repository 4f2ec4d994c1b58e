#include "read/mitsuba/load.h"

#include "base/file_use.h"
#include "base/log.h"
#include "base/values.h"
#include "read/mitsuba/parsers.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal::mitsuba {

namespace {

// Sensors by id, or by number where they have none: "camera, 1".
std::string sensors_text(const std::vector<Sensor> &sensors) {
    std::vector<std::string> names;
    for (size_t i = 0; i < sensors.size(); i++)
        names.push_back(sensors[i].id.empty() ? std::to_string(i) : fmt::format("{} ({})", i, sensors[i].id));
    return joined(names);
}

const Sensor &choose_sensor(const std::vector<Sensor> &sensors, const std::string &wanted) {
    if (wanted.empty())
        return sensors.front();
    for (size_t i = 0; i < sensors.size(); i++)
        if (sensors[i].id == wanted || std::to_string(i) == wanted)
            return sensors[i];
    throw UsageError(
        fmt::format("--sensor {}: there is no such <sensor>; available: {}", wanted, sensors_text(sensors)));
}

// Reads all sensors, so that a mistake in one is told whichever is taken.
void read_sensors(Importer &importer, Object &root, const LoadOptions &options, SceneDescription &scene) {
    const ParseContext &context = importer.context();
    std::vector<Sensor> sensors;
    for (const auto &child : root.children("sensor"))
        context.attempt(*child, [&] { sensors.push_back(parse_sensor(importer, *child)); });
    if (sensors.empty() && options.sensor.empty()) {
        sensors.push_back(default_sensor());
        sensors.back().camera.place = sensors.back().sampler_place = root.place();
    }
    const Sensor &sensor = choose_sensor(sensors, options.sensor);
    if (&sensor != &sensors.front()) // another image of the same files
        context.hashes->add(fmt::format("sensor {}", &sensor - sensors.data()));
    scene.camera = sensor.camera;
    scene.spp = sensor.spp;
    scene.sample_count_given = sensor.sample_count_given;
    scene.sampler_place = sensor.sampler_place;
    scene.strategy[AXIS_sampler] = sensor.sampler;
}

void read_integrator(Importer &importer, Object &root, SceneDescription &scene) {
    const ParseContext &context = importer.context();
    set_default_strategy(scene);
    if (const auto integrator = only_child(root, "integrator"))
        context.attempt(*integrator, [&] { parse_integrator(importer, *integrator, scene); });
}

// Says what Opal chose where the file leaves it open.
void tell_choices(Object &root, const LoadOptions &options, const SceneDescription &scene) {
    const size_t sensors = root.children("sensor").size();
    if (sensors == 0)
        info(fmt::format("no <sensor>: a camera at the origin that looks along +z, {} x {} pixels, {} samples",
                         scene.camera.width, scene.camera.height, scene.spp));
    else if (sensors > 1 && options.sensor.empty())
        info(fmt::format("the camera is the first of {} sensors; --sensor takes another one", sensors));
    if (root.children("integrator").empty())
        info("no <integrator>: path, as Mitsuba's is without any property");
    for (const PluginUse &use : scene.plugins)
        if (use.tag == "sampler" && use.becomes != use.type)
            info(fmt::format("sampler {}: Opal's nearest is {}", use.type,
                             axes()[AXIS_sampler].choices[scene.strategy[AXIS_sampler]].name));
}

void warn_if_black(const SceneDescription &scene) {
    if (scene.meshes.empty() &&
        std::ranges::none_of(scene.lights, [](const Light &light) { return is_environment(light.kind()); }))
        warn(scene.place.text() + ": the scene has no <shape>; it renders black");
    else if (!has_light(scene))
        warn(scene.place.text() + ": the scene has no <emitter>; it renders black");
}

// Under volpath, shadow rays pass surfaces that let light through without turning it, and these are no segment of a
// path. Under path they block shadow rays, and are one.
void warn_of_volpath(Object &root, const SceneDescription &scene) {
    const auto is_volpath = [](const PluginUse &use) { return use.type.starts_with("volpath"); };
    const auto lets_through = [](const Mesh &mesh) {
        return mesh.bsdf.leads_to(BSDF_mask) || mesh.bsdf.leads_to(BSDF_null);
    };
    if (std::ranges::none_of(scene.plugins, is_volpath) || std::ranges::none_of(scene.meshes, lets_through))
        return;
    if (const unsigned depth = scene.strategy.max_depth; depth != no_limit)
        warn(
            fmt::format("{}: Mitsuba's volpath does not count mask and null as segments of a path; Opal counts them as "
                        "its path does, so that max_depth {} ends paths earlier",
                        root.children("integrator").front()->place_of("max_depth").text(), depth));
    if (const Light *light = light_missed_by_bsdfs(scene))
        warn(fmt::format("{}: Mitsuba's volpath finds this light through mask and null; Opal renders as its path does, "
                         "where they throw full shadows",
                         light->place.text()));
}

// The power of an infinite light is that on a sphere around the scene, which tells little of the light on a surface.
// Beside one, all lights are chosen alike: by power, a spot under a weak sky took 49 times as many samples.
void choose_emitter_choice(SceneDescription &scene) {
    if (std::ranges::any_of(scene.lights, [](const Light &light) { return is_infinite(light.kind()); }))
        scene.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_uniform;
}

// Objects beside the sensors, to which these refer: those that nothing refers to are looked at, too.
void check_unused(Importer &importer, Object &root) {
    Sensor unused = default_sensor();
    const auto check = [&](const char *tag, auto parse) {
        for (const auto &object : root.children(tag))
            if (!importer.has_met(*object))
                importer.context().attempt(*object, [&] { parse(*object); });
    };
    check("film", [&](Object &film) { parse_film(importer, film, unused.camera); });
    check("sampler", [&](Object &sampler) { parse_sampler(importer, sampler, unused); });
    check("rfilter", [&](Object &filter) { parse_filter(importer, filter, unused.camera.filter); });
    root.children("spectrum"); // which colours refer to
}

SceneDescription parse_scene(Importer &importer, Object &root, const LoadOptions &options) {
    const ParseContext &context = importer.context();
    SceneDescription scene;
    scene.place = root.place();
    scene.dialect = Dialect::mitsuba;
    read_integrator(importer, root, scene);
    read_sensors(importer, root, options, scene);
    for (const auto &bsdf : root.children("bsdf")) // also those that nothing refers to
        importer.bsdf(*bsdf);
    for (const auto &texture : root.children("texture")) // likewise
        importer.texture(*texture);
    for (const auto &shape : root.children("shape"))
        parse_shape(importer, *shape, scene);
    for (const auto &emitter : root.children("emitter"))
        if (!importer.is_area_light_of_shape(*emitter))
            context.attempt(*emitter, [&] { scene.lights.push_back(parse_scene_emitter(importer, *emitter)); });
    choose_emitter_choice(scene);
    for (const char *tag : {"medium", "phase", "volume"})
        for (const auto &object : root.children(tag))
            importer.refuse(*object, "it is left out");
    check_unused(importer, root);
    root.finish();
    importer.finish();
    return scene;
}

} // namespace

SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options) {
    FileHashes hashes;
    Mistakes mistakes;
    // Names in a scene that comes by /dev/stdin are of the current folder.
    ParseContext context{descriptor_of(file) ? std::filesystem::path() : file.parent_path(), options.lenient,
                         &mistakes};
    context.hashes = &hashes;
    const MitsubaScene document = read_document(file, options.definitions, context);
    if (document.root->tag() != "scene")
        document.root->mistake(
            fmt::format("the root is a <{}>; a scene's is <scene version=\"3.0.0\">", document.root->tag()));
    Importer importer(context);
    SceneDescription scene = parse_scene(importer, *document.root, options);
    mistakes.throw_all();
    scene.file = file;
    scene.definitions = document.definitions;
    scene.hash = hashes.value();
    scene.plugins = importer.uses();
    tell_choices(*document.root, options, scene);
    warn_if_black(scene);
    warn_of_volpath(*document.root, scene);
    return scene;
}

} // namespace opal::mitsuba
