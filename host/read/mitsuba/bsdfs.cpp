// Parsers of materials.
#include "read/mitsuba/parsers.h"
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

// The parameters of Disney's materials bear Mitsuba's names.
void set_parameters(Importer &importer, Object &object, Bsdf &bsdf, const std::string &but) {
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
        if (parameter.name != but)
            set_parameter(importer, object, parameter.name, bsdf, parameter.name);
}

Bsdf parse_principled(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_principled_record{};
    set_parameters(importer, object, bsdf, "eta");
    const auto eta = object.number("eta"), specular = object.number("specular");
    object.check(!eta || *eta > 0, "eta", "must be above 0");
    object.check(!specular || BETWEEN(0, 1).holds(*specular), "specular", "must be " + text_of(BETWEEN(0, 1)));
    object.check(!eta || !specular, "specular", "stands for eta, which is given too");
    auto record = bsdf.as<bsdf_principled_record>();
    record.eta = principled_index(eta, specular, record.spec_trans.value > 0);
    bsdf.words = words_of(record);
    for (const char *name : {"main_specular_sampling_rate", "clearcoat_sampling_rate",
                             "diffuse_reflectance_sampling_rate"}) // noise alone depends on them
        object.ignore(name);
    return bsdf;
}

Bsdf parse_principledthin(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_principledthin_record{};
    set_parameters(importer, object, bsdf, "");
    for (const char *name : {"specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate",
                             "diffuse_transmittance_sampling_rate", "diffuse_reflectance_sampling_rate"})
        object.ignore(name);
    return bsdf;
}

Bsdf parse_null(Importer &, Object &) { return bsdf_null_record{}; }

const std::vector<Plugin<Bsdf (*)(Importer &, Object &)>> bsdf_types = {
    {"diffuse", "diffuse", parse_diffuse},
    {"dielectric", "dielectric", parse_dielectric},
    {"conductor", "mirror", parse_conductor},
    {"twosided", "twosided", parse_twosided},
    {"mask", "mask", parse_mask},
    {"null", "null", parse_null},
    {"principled", "principled", parse_principled},
    {"principledthin", "principledthin", parse_principledthin},
};

} // namespace

void parse_bsdf(Importer &importer, Object &object, Bsdf &bsdf) {
    const auto *type = importer.row_of_type(object, bsdf_types, "a diffuse one of reflectance 0.5 stands in for it");
    if (!type)
        return;
    const SourcePlace place = object.place();
    importer.context().attempt(object, [&] { bsdf = type->parse(importer, object); });
    bsdf.place = place;
    object.finish();
}

} // namespace opal::mitsuba
