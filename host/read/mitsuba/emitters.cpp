// Parsers of emitters. Area lights are children of a shape, others of the scene.
#include "base/log.h"
#include "read/environment.h"
#include "read/mitsuba/parsers.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <tuple>
#include <utility>

namespace opal::mitsuba {

namespace {

constexpr double full_sphere = 4 * std::numbers::pi; // solid angle of all directions

// What is emitted: a radiance, an intensity or an irradiance.
Color parse_emission(Importer &importer, Object &object, const char *name) {
    const Color color = importer.color(object, name, SpectrumUse::radiance, {1, 1, 1});
    object.check(*std::ranges::min_element(color) >= 0, name, "must not be negative");
    return color;
}

// The same where it may be a texture, which then multiplies white; 0.5 stands in for one that cannot be read.
std::pair<Color, std::optional<Texture>> parse_textured_emission(Importer &importer, Object &object, const char *name) {
    if (object.color(name, SpectrumUse::radiance) || !object.has(name))
        return {parse_emission(importer, object, name), std::nullopt};
    const std::optional<Texture> texture = importer.texture(object, name);
    const double grey = texture ? 1 : 0.5;
    return {Color{grey, grey, grey}, texture};
}

// Either a property of its own or to_world says it; Mitsuba refuses both together.
void refuse_both(Object &object, const char *name) {
    if (object.has(name) && object.has("to_world"))
        object.mistake_at(name, "stands beside to_world, which says it, too: give one of both");
}

EmitterParameters parse_point(Importer &importer, Object &object) {
    refuse_both(object, "position");
    const Transform to_world = object.transform("to_world").value_or(Transform());
    Color power = parse_emission(importer, object, "intensity");
    for (double &channel : power)
        channel *= full_sphere;
    return emitter_point{.position = object.point("position").value_or(to_world.point({})), .power = power};
}

EmitterParameters parse_spot(Importer &importer, Object &object) {
    const Transform to_world = object.transform("to_world").value_or(Transform());
    object.check(why_no_sphere(to_world).empty(), "to_world",
                 "a spot light must be scaled alike along all axes: its cone would not be round");
    const Color intensity = parse_emission(importer, object, "intensity");
    const double cutoff = object.number("cutoff_angle").value_or(20);
    const double beam = object.number("beam_width").value_or(0.75 * cutoff);
    object.check(cutoff > 0 && cutoff <= 180, "cutoff_angle", "must be above 0 and at most 180 degrees");
    object.check(beam >= 0 && beam <= 180, "beam_width", "must be from 0 to 180 degrees");
    return emitter_spot{.position = to_world.point({}),
                        .direction = to_world.vector({0, 0, 1}),
                        .intensity = intensity,
                        .cutoff_angle = cutoff,
                        .beam_width = beam};
}

// The texture of a spot, which lies across its axis.
std::optional<LightTexture> parse_light_texture(Importer &importer, Object &object) {
    const auto child = object.child_named("texture");
    if (!child)
        return std::nullopt;
    const std::optional<Texture> &texture = importer.texture(*child);
    if (!texture)
        return std::nullopt;
    if (std::holds_alternative<MeshAttributeTexture>(*texture)) {
        object.mistake_at("texture", "a spot is no mesh, which has attributes");
        return std::nullopt;
    }
    const Transform to_world = object.transform("to_world").value_or(Transform());
    return LightTexture{*texture, normalize(to_world.vector({1, 0, 0})), normalize(to_world.vector({0, 1, 0}))};
}

// Mitsuba doubles an image of one row or column.
double shown_length(int pixels) { return std::max(pixels, 2); }

// In Mitsuba it shines in proportion to the scale of to_world.
EmitterParameters parse_projector(Importer &importer, Object &object) {
    const Transform to_world = object.transform("to_world").value_or(Transform());
    object.check(why_no_sphere(to_world).empty(), "to_world", "a projector must be scaled alike along all axes");
    auto [irradiance, texture] = parse_textured_emission(importer, object, "irradiance");
    const double scale = object.number("scale").value_or(1);
    object.check(scale >= 0, "scale", "must not be negative");
    for (double &channel : irradiance)
        channel *= scale * length(to_world.vector({0, 0, 1}));
    double width = 1, height = 1;
    if (const auto *bitmap = texture ? std::get_if<BitmapTexture>(&*texture) : nullptr) {
        width = shown_length(bitmap->picture->width);
        height = shown_length(bitmap->picture->height);
    }
    return emitter_projector{.position = to_world.point({}),
                             .direction = to_world.vector({0, 0, 1}),
                             .up = to_world.vector({0, 1, 0}),
                             .irradiance = irradiance,
                             .fov = parse_fov(object, width, height),
                             .aspect = width / height};
}

// The image of a projector, whose first texel is to the left and at the top as the projector looks: at +x and +y.
std::optional<LightTexture> parse_image(Importer &importer, Object &object) {
    const auto textures = object.children("texture");
    const std::optional<Texture> texture = textures.empty() ? std::nullopt : importer.texture(*textures.front());
    if (!texture)
        return std::nullopt;
    const Transform to_world = object.transform("to_world").value_or(Transform());
    return LightTexture{*texture, normalize(to_world.vector({-1, 0, 0})), normalize(to_world.vector({0, -1, 0}))};
}

EmitterParameters parse_directional(Importer &importer, Object &object) {
    refuse_both(object, "direction");
    const Transform to_world = object.transform("to_world").value_or(Transform());
    const Vec3 direction = object.vector("direction").value_or(to_world.vector({0, 0, 1}));
    object.check(length(direction) > 0, "direction", "must not be 0 0 0");
    if (!keeps_lengths(to_world))
        warn(fmt::format("{}: to_world scales this light; Mitsuba lights surfaces that many times more, Opal takes the "
                         "direction alone: the irradiance stays as it is written",
                         object.place_of("to_world").text()));
    return emitter_directional{.direction = direction, .irradiance = parse_emission(importer, object, "irradiance")};
}

EmitterParameters parse_constant(Importer &importer, Object &object) {
    object.ignore("to_world"); // it is the same from everywhere
    return emitter_constant{.radiance = parse_emission(importer, object, "radiance")};
}

EmitterParameters parse_envmap(Importer &importer, Object &object) {
    emitter_envmap light;
    light.scale = object.number("scale").value_or(1);
    object.check(light.scale >= 0, "scale", "must not be negative");
    light.to_world = object.transform("to_world").value_or(Transform());
    warn_of_scale(light.to_world, object.place_of("to_world"));
    light.mis_compensation = object.boolean("mis_compensation").value_or(false);
    const auto file = object.file("filename");
    if (!object.has("filename"))
        object.mistake("the emitter lacks its filename: <string name=\"filename\" value=\"a.exr\"/>");
    if (!file)
        throw NoObject{};
    try {
        light.map = read_environment(*file, importer.context().hashes);
    } catch (const Error &error) {
        importer.lacks(object, "filename", error.what(), "the emitter is left out");
        throw NoObject{};
    }
    return light;
}

const char *const area = "area";

// area: without a parser, a child of a shape.
const std::vector<Plugin<EmitterParameters (*)(Importer &, Object &)>> emitter_types = {
    {area, "area light", nullptr},
    {"point", "point", parse_point},
    {"spot", "spot", parse_spot},
    {"directional", "directional", parse_directional},
    {"projector", "projector", parse_projector},
    {"constant", "constant", parse_constant},
    {"envmap", "envmap", parse_envmap},
};

// Of a type that Opal has, in the place where it stands. Else throws NoObject.
const auto &type_in(Importer &importer, Object &object, const char *parent) {
    const auto *type = importer.row_of_type(object, emitter_types, "it is left out");
    if (!type)
        throw NoObject{};
    const std::string wanted = type->parse ? "scene" : "shape";
    if (wanted != parent) {
        object.mistake(fmt::format("emitter '{}' must stand in a <{}>, not in a <{}>", type->name, wanted, parent));
        throw NoObject{};
    }
    object.ignore("sampling_weight"); // how often it is drawn: --emitter-choice says that
    return *type;
}

} // namespace

void parse_area_emitter(Importer &importer, Object &object, Mesh &mesh) {
    type_in(importer, object, "shape");
    importer.add_area_light(object);
    std::tie(mesh.radiance, mesh.texture) = parse_textured_emission(importer, object, "radiance");
    object.finish();
}

Light parse_scene_emitter(Importer &importer, Object &object) {
    const auto &type = type_in(importer, object, "scene");
    std::optional<EmitterParameters> parameters;
    importer.context().attempt(object, [&] { parameters = type.parse(importer, object); });
    if (!parameters) {
        object.finish();
        throw NoObject{};
    }
    Light light{std::move(*parameters), object.place()};
    if (const auto *spot = std::get_if<emitter_spot>(&light.parameters)) {
        light.texture = parse_light_texture(importer, object);
        object.check(!light.texture || spot->cutoff_angle < 90, "cutoff_angle",
                     "must be below 90 degrees where the spot has a texture, which lies on a plane across its axis");
    }
    if (std::holds_alternative<emitter_projector>(light.parameters))
        light.texture = parse_image(importer, object);
    object.finish();
    return light;
}

} // namespace opal::mitsuba
