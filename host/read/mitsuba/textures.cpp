// Parsers of textures.
#include "read/mitsuba/parsers.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal::mitsuba {

namespace {

// A matrix for points of the plane: a translation is in the fourth column, as of matrices for points of space.
UvTransform parse_to_uv(Object &object) {
    const auto &m = object.transform("to_uv").value_or(Transform()).rows;
    return {{{m[0][0], m[0][1], m[0][3]}, {m[1][0], m[1][1], m[1][3]}}};
}

// The index of a property's value in a list, of which the first is the default.
uint parse_choice(Object &object, const char *name, const std::vector<std::string> &choices) {
    const std::string text = object.string(name).value_or(choices.front());
    const auto found = std::ranges::find(choices, text);
    object.check(found != choices.end(), name, unknown_name("value", text, choices));
    return found == choices.end() ? 0 : uint(found - choices.begin());
}

Texture parse_checkerboard(Importer &importer, Object &object) {
    CheckerboardTexture texture;
    texture.color0 = importer.color(object, "color0", SpectrumUse::reflectance, texture.color0);
    texture.color1 = importer.color(object, "color1", SpectrumUse::reflectance, texture.color1);
    texture.to_uv = parse_to_uv(object);
    return texture;
}

Texture parse_bitmap(Importer &importer, Object &object) {
    BitmapTexture texture;
    texture.raw = object.boolean("raw").value_or(false);
    texture.nearest = parse_choice(object, "filter_type", {"bilinear", "nearest"}) == 1;
    texture.wrap = parse_choice(object, "wrap_mode", {"repeat", "mirror", "clamp"}); // in the order of WRAP_*
    texture.to_uv = parse_to_uv(object);
    // How texels are held: Opal keeps 8 bits and 32 as they are, and 16 as half floats, as Mitsuba's auto does.
    const std::vector<std::string> formats = {"auto", "variant", "float16", "fp16", "uint8"};
    texture.full_precision = formats[parse_choice(object, "format", formats)] == "variant";
    object.boolean("accel");
    const auto file = object.file("filename", "0.5 stands in for the texture");
    if (!object.has("filename"))
        object.mistake("the texture lacks its filename: <string name=\"filename\" value=\"a.png\"/>");
    if (!file)
        throw NoObject{};
    const auto lacks = [&importer, &object](const std::string &message) {
        importer.lacks(object, "filename", message, "0.5 stands in for the texture");
    };
    try {
        texture.picture = importer.context().pictures->load(*file, importer.context().hashes, lacks);
    } catch (const Error &error) {
        lacks(error.what());
        throw NoObject{};
    }
    return texture;
}

Texture parse_mesh_attribute(Importer &, Object &object) {
    MeshAttributeTexture texture;
    texture.name = object.string("name").value_or("");
    object.check(texture.name.starts_with("vertex_") || texture.name.starts_with("face_"), "name",
                 "the texture needs the name of an attribute, which begins with vertex_ or face_");
    texture.scale = object.number("scale").value_or(1);
    return texture;
}

const std::vector<Plugin<Texture (*)(Importer &, Object &)>> texture_types = {
    {"checkerboard", "checkerboard", parse_checkerboard},
    {"bitmap", "bitmap", parse_bitmap},
    {"mesh_attribute", "mesh_attribute", parse_mesh_attribute},
};

} // namespace

std::optional<Texture> parse_texture(Importer &importer, Object &object) {
    const auto *type = importer.row_of_type(object, texture_types, "0.5 stands in for it");
    if (!type)
        return std::nullopt;
    std::optional<Texture> texture;
    importer.context().attempt(object, [&] { texture = type->parse(importer, object); });
    object.finish();
    return texture;
}

} // namespace opal::mitsuba
