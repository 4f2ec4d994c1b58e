// Parsers of materials.
#include "base/log.h"
#include "read/mitsuba/parsers.h"
#include "read/texture_values.h"
#include "scene/index_of_refraction.h"

#include <fmt/format.h>

#include <bit>

namespace opal::mitsuba {

namespace {

constexpr Color white{1, 1, 1};

// A property of which Opal has the value 1 alone.
void require_white(Importer &importer, Object &object, const char *name) {
    if (importer.color(object, name, SpectrumUse::reflectance, white) != white)
        importer.lacks(object, name, "Opal has only 1 here yet", "1 stands in for it");
}

// Sets a parameter of the material to that property: a texture, or a constant, of which the channels' mean is taken
// where it is one number. It keeps its default if the property is not given.
void set_parameter(Importer &importer, Object &object, const std::string &property, Bsdf &bsdf,
                   const std::string &name) {
    const Parameter &parameter = find_row(bsdf_parameters(bsdf.kind()), "parameter", name);
    const auto set = [&](const Color &color) {
        const auto put = [&](size_t i, double x) { bsdf.words[parameter.word + i] = std::bit_cast<uint>(float(x)); };
        if (parameter.type == ParameterType::NUMBER)
            return put(0, (color[0] + color[1] + color[2]) / 3);
        for (size_t i = 0; i < color.size(); i++)
            put(i, color[i]);
    };
    if (const std::optional<Color> color = object.color(property, SpectrumUse::reflectance)) {
        for (double channel : *color)
            object.check(parameter.range.holds(channel), property, "must be " + text_of(parameter.range));
        set(*color);
    } else if (const std::optional<Texture> texture = importer.texture(object, property)) {
        set(white); // which the texture multiplies
        bsdf.textures[parameter.texture_word] = *texture;
        importer.context().pictures->when_loaded([place = object.place_of(property), &parameter, texture = *texture] {
            warn_of_values(place, parameter, texture);
        });
    }
}

Bsdf parse_diffuse(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_diffuse_record{};
    set_parameter(importer, object, "reflectance", bsdf, "albedo");
    return bsdf;
}

// An index of refraction: a number, or the name of a material.
double parse_index(Object &object, const char *name, const std::string &otherwise) {
    if (const std::optional<std::string> medium = object.string_if(name)) {
        const std::optional<double> index = index_of_refraction(*medium);
        object.check(index.has_value(), name, unknown_name("medium", *medium, names_of(media())));
        return index.value_or(1);
    }
    const double index = object.number(name).value_or(*index_of_refraction(otherwise));
    object.check(index > 0, name, "must be above 0");
    return index;
}

Bsdf parse_dielectric(Importer &importer, Object &object) {
    const double inside = parse_index(object, "int_ior", "bk7"), outside = parse_index(object, "ext_ior", "air");
    require_white(importer, object, "specular_reflectance");
    require_white(importer, object, "specular_transmittance");
    return bsdf_dielectric_record{.int_ior = inside, .ext_ior = outside};
}

// Opal's mirror is the conductor that reflects everything.
Bsdf parse_conductor(Importer &importer, Object &object) {
    const bool has_material = object.string("material").value_or("none") != "none";
    const char *const other = has_material ? "material" : object.has("eta") ? "eta" : object.has("k") ? "k" : nullptr;
    if (other)
        importer.lacks(object, other, "Opal has only the conductor that reflects everything yet, material none",
                       "that one stands in for it");
    for (const char *name : {"eta", "k"})
        object.ignore(name);
    require_white(importer, object, "specular_reflectance");
    return bsdf_mirror_record{};
}

// The materials within a material, of which there must be so many.
std::vector<Bsdf> parse_children(Importer &importer, Object &object, size_t least, size_t most) {
    std::vector<Bsdf> made;
    const auto children = object.children("bsdf");
    for (const auto &child : children)
        made.push_back(importer.bsdf(*child));
    if (children.size() < least || children.size() > most) {
        object.mistake(fmt::format("a {} has {} <bsdf> within it, not {}", object.type(),
                                   least == most ? fmt::format("{}", least) : fmt::format("{} or {}", least, most),
                                   children.size()));
        throw NoObject{};
    }
    return made;
}

Bsdf parse_twosided(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_twosided_record{};
    bsdf.children = parse_children(importer, object, 1, 2);
    for (const Bsdf &child : bsdf.children)
        if (child.traits() & OPAL_TRANSMITS)
            throw XmlError(child.place, "a twosided cannot hold a BSDF that light passes through");
    return bsdf;
}

Bsdf parse_mask(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_mask_record{};
    set_parameter(importer, object, "opacity", bsdf, "opacity");
    bsdf.children = parse_children(importer, object, 1, 1);
    return bsdf;
}

Bsdf parse_blendbsdf(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_blendbsdf_record{};
    if (!object.has("weight"))
        object.mistake("a blendbsdf needs a property 'weight'");
    set_parameter(importer, object, "weight", bsdf, "weight");
    bsdf.children = parse_children(importer, object, 2, 2);
    return bsdf;
}

// Sets what normalmap and bumpmap have in common: the two flags and the material within.
void set_perturbation(Importer &importer, Object &object, Bsdf &bsdf) {
    for (const char *name : {"flip_invalid_normals", "use_shadowing_function"})
        bsdf.words[find_row(bsdf_parameters(bsdf.kind()), "parameter", name).word] =
            object.boolean(name).value_or(true);
    bsdf.children = parse_children(importer, object, 1, 1);
}

Bsdf parse_normalmap(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_normalmap_record{};
    if (!object.has("normalmap"))
        object.mistake("a normalmap needs a <texture> named 'normalmap'");
    set_parameter(importer, object, "normalmap", bsdf, "normal");
    for (const auto &[word, texture] : bsdf.textures)
        if (const auto *bitmap = std::get_if<BitmapTexture>(&texture);
            bitmap && bitmap->picture->encoded && !bitmap->raw)
            note(object.place_of("normalmap").text() +
                 ": these normals are decoded as sRGB, because 'raw' is not true: flat ones tilt by 38.8 degrees");
    set_perturbation(importer, object, bsdf);
    return bsdf;
}

Bsdf parse_bumpmap(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_bumpmap_record{.height = 1};
    const auto textures = object.children("texture");
    if (textures.size() != 1) {
        object.mistake(fmt::format("a bumpmap has 1 <texture> within it, not {}", textures.size()));
        throw NoObject{};
    }
    if (const std::optional<Texture> &texture = importer.texture(*textures.front())) {
        if (!std::holds_alternative<BitmapTexture>(*texture))
            textures.front()->mistake("a bumpmap needs a texture of type bitmap, which has slopes");
        bsdf.textures[find_row(bsdf_parameters(BSDF_bumpmap), "parameter", "height").texture_word] = *texture;
    }
    set_perturbation(importer, object, bsdf);
    const double scale = object.number("scale").value_or(1);
    bsdf.words[find_row(bsdf_parameters(BSDF_bumpmap), "parameter", "scale").word] = std::bit_cast<uint>(float(scale));
    return bsdf;
}

Bsdf parse_null(Importer &, Object &) { return bsdf_null_record{}; }

const std::vector<Plugin<Bsdf (*)(Importer &, Object &)>> bsdf_types = {
    {"diffuse", "diffuse", parse_diffuse},
    {"dielectric", "dielectric", parse_dielectric},
    {"conductor", "mirror", parse_conductor},
    {"twosided", "twosided", parse_twosided},
    {"mask", "mask", parse_mask},
    {"blendbsdf", "blendbsdf", parse_blendbsdf},
    {"normalmap", "normalmap", parse_normalmap},
    {"bumpmap", "bumpmap", parse_bumpmap},
    {"null", "null", parse_null},
};

} // namespace

void parse_bsdf(Importer &importer, Object &object, Bsdf &bsdf) {
    const auto *type = importer.row_of_type(object, bsdf_types, "a diffuse one of reflectance 0.5 stands in for it");
    if (!type)
        return;
    const SourcePlace place = object.place();
    importer.context().attempt(object, [&] {
        Bsdf made = type->parse(importer, object);
        made.place = place;
        made.check_count();
        bsdf = std::move(made);
    });
    object.finish();
}

} // namespace opal::mitsuba
