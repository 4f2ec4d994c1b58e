// Parsers of materials.
#include "base/log.h"
#include "read/mitsuba/parsers.h"
#include "read/texture_values.h"
#include "scene/bsdf_rules.h"
#include "scene/index_of_refraction.h"
#include "scene/metals.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cctype>

namespace opal::mitsuba {

namespace {

constexpr Color white{1, 1, 1};

// Sets a parameter of the material to that property: a texture, or a constant, of which the channels' mean is taken
// where it is one number. It keeps its default if the property is not given.
void set_parameter(Importer &importer, Object &object, const std::string &property, Bsdf &bsdf, const std::string &name,
                   SpectrumUse use = SpectrumUse::reflectance) {
    const Parameter &parameter = find_row(bsdf_parameters(bsdf.kind()), "parameter", name);
    const auto set = [&](const Color &color) {
        const auto put = [&](size_t i, double x) { bsdf.words[parameter.word + i] = std::bit_cast<uint>(float(x)); };
        if (parameter.type == ParameterType::NUMBER)
            return put(0, (color[0] + color[1] + color[2]) / 3);
        for (size_t i = 0; i < color.size(); i++)
            put(i, color[i]);
    };
    if (const std::optional<Color> color = object.color(property, use)) {
        for (double channel : *color)
            object.check(parameter.range.holds(channel), property, "must be " + text_of(parameter.range));
        set(*color);
    } else if (std::optional<Texture> texture = importer.texture(object, property)) {
        // Where Mitsuba 3.9.1 wants one number of a checkerboard, the colours change places.
        if (auto *squares = std::get_if<CheckerboardTexture>(&*texture);
            squares && parameter.type == ParameterType::NUMBER)
            std::swap(squares->color0, squares->color1);
        set(white); // which the texture multiplies
        bsdf.textures[parameter.texture_word] = *texture;
        importer.context().pictures->when_loaded([place = object.place_of(property), &parameter, texture = *texture] {
            warn_of_values(place, parameter, texture);
        });
    }
}

void set_number(Bsdf &bsdf, std::string_view name, double number) {
    bsdf.words[bsdf_parameter(bsdf.kind(), name)->word] = std::bit_cast<uint>(float(number));
}

void set_flag(Bsdf &bsdf, std::string_view name, bool flag) {
    bsdf.words[bsdf_parameter(bsdf.kind(), name)->word] = flag;
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

// The indices of both sides. inside: the medium that is meant where the file says none
void set_indices(Object &object, Bsdf &bsdf, const std::string &inside) {
    set_number(bsdf, "int_ior", parse_index(object, "int_ior", inside));
    set_number(bsdf, "ext_ior", parse_index(object, "ext_ior", "air"));
    object.check(!has_equal_indices(bsdf), "int_ior", "must differ from ext_ior");
}

// The parameters of every boundary between two media.
void set_boundary(Importer &importer, Object &object, Bsdf &bsdf) {
    set_indices(object, bsdf, "bk7");
    for (const char *name : {"specular_reflectance", "specular_transmittance"})
        set_parameter(importer, object, name, bsdf, name);
}

Bsdf parse_dielectric(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_dielectric_record{};
    set_boundary(importer, object, bsdf);
    return bsdf;
}

Bsdf parse_thindielectric(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_thindielectric_record{};
    set_boundary(importer, object, bsdf);
    return bsdf;
}

// The parameters of every metal.
void set_metal(Importer &importer, Object &object, Bsdf &bsdf) {
    const std::string material = object.string("material").value_or("none");
    for (const char *name : {"eta", "k"}) {
        object.check(material == "none" || !object.has(name), name, "a metal has either a material, or eta and k");
        set_parameter(importer, object, name, bsdf, name, SpectrumUse::index);
    }
    if (const Metal *const metal = find_metal(material); !metal)
        object.mistake_at("material", unknown_name("material", material, names_of(metals())));
    else if (material != "none") {
        set_color(bsdf, "eta", metal->eta);
        set_color(bsdf, "k", metal->k);
    }
    set_parameter(importer, object, "specular_reflectance", bsdf, "specular_reflectance");
}

// Which facets there are, in upper or lower case as Mitsuba has it, and which are drawn.
void set_facet_choices(Object &object, Bsdf &bsdf) {
    std::string name = object.string("distribution").value_or("beckmann");
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    object.check(name == "ggx" || name == "beckmann", "distribution",
                 unknown_name("distribution", name, {"beckmann", "ggx"}));
    set_flag(bsdf, "ggx", name == "ggx");
    set_flag(bsdf, "sample_visible", object.boolean("sample_visible").value_or(true));
}

// Which roughnesses are given: one, or two, or none.
void check_alphas(Object &object) {
    const bool one = object.has("alpha");
    for (const char *name : {"alpha_u", "alpha_v"})
        object.check(!one || !object.has(name), name, "there is either alpha, or alpha_u and alpha_v");
    if (!one && object.has("alpha_u") != object.has("alpha_v"))
        object.mistake("alpha_u and alpha_v must be given together");
}

// The parameters of facets of two roughnesses.
void set_facets(Importer &importer, Object &object, Bsdf &bsdf) {
    check_alphas(object);
    for (const char *name : {"alpha_u", "alpha_v"}) {
        set_parameter(importer, object, "alpha", bsdf, name);
        set_parameter(importer, object, name, bsdf, name);
    }
    set_facet_choices(object, bsdf);
}

// A conductor, or the mirror that the one without parameters is.
Bsdf simplest(const Bsdf &bsdf) {
    return bsdf.words == words_of(bsdf_conductor_record{}) && bsdf.textures.empty() ? Bsdf(bsdf_mirror_record{}) : bsdf;
}

Bsdf parse_conductor(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_conductor_record{};
    set_metal(importer, object, bsdf);
    return simplest(bsdf);
}

Bsdf parse_roughconductor(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_roughconductor_record{};
    set_metal(importer, object, bsdf);
    set_facets(importer, object, bsdf);
    return simplest(without_facets(bsdf));
}

Bsdf parse_roughdielectric(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_roughdielectric_record{};
    set_boundary(importer, object, bsdf);
    set_facets(importer, object, bsdf);
    return without_facets(bsdf);
}

// The parameters of every plastic.
void set_plastic(Importer &importer, Object &object, Bsdf &bsdf) {
    set_indices(object, bsdf, "polypropylene");
    for (const char *name : {"diffuse_reflectance", "specular_reflectance"})
        set_parameter(importer, object, name, bsdf, name);
    set_flag(bsdf, "nonlinear", object.boolean("nonlinear").value_or(false));
}

Bsdf checked_plastic(Object &object, const Bsdf &bsdf) {
    object.check(!is_too_dense(bsdf), "int_ior", too_dense_text("ext_ior"));
    return bsdf;
}

Bsdf parse_plastic(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_plastic_record{};
    set_plastic(importer, object, bsdf);
    return checked_plastic(object, bsdf);
}

Bsdf parse_roughplastic(Importer &importer, Object &object) {
    Bsdf bsdf = bsdf_roughplastic_record{};
    set_plastic(importer, object, bsdf);
    check_alphas(object);
    const Parameter &alpha = *bsdf_parameter(BSDF_roughplastic, "alpha");
    for (const char *name : {"alpha", "alpha_u", "alpha_v"})
        if (const std::optional<double> given = object.number(name)) {
            object.check(alpha.range.holds(*given), name, "must be " + text_of(alpha.range));
            set_number(bsdf, "alpha", *given);
        }
    object.check(!object.has("alpha_u") || !object.has("alpha_v") ||
                     object.number("alpha_u") == object.number("alpha_v"),
                 "alpha_v", "must be alpha_u: roughplastic has one roughness in all directions");
    set_facet_choices(object, bsdf);
    return checked_plastic(object, without_facets(bsdf));
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
        set_flag(bsdf, name, object.boolean(name).value_or(true));
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
    set_number(bsdf, "scale", object.number("scale").value_or(1));
    set_perturbation(importer, object, bsdf);
    const auto textures = object.children("texture");
    if (textures.size() != 1) {
        object.mistake(fmt::format("a bumpmap has 1 <texture> within it, not {}", textures.size()));
        throw NoObject{};
    }
    if (const std::optional<Texture> &texture = importer.texture(*textures.front())) {
        if (!std::holds_alternative<BitmapTexture>(*texture))
            textures.front()->mistake("a bumpmap needs a texture of type bitmap, which has slopes");
        bsdf.textures[bsdf_parameter(BSDF_bumpmap, "height")->texture_word] = *texture;
    }
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
    {"thindielectric", "thindielectric", parse_thindielectric},
    {"roughdielectric", "roughdielectric", parse_roughdielectric},
    {"conductor", "conductor", parse_conductor},
    {"roughconductor", "roughconductor", parse_roughconductor},
    {"plastic", "plastic", parse_plastic},
    {"roughplastic", "roughplastic", parse_roughplastic},
    {"twosided", "twosided", parse_twosided},
    {"mask", "mask", parse_mask},
    {"blendbsdf", "blendbsdf", parse_blendbsdf},
    {"normalmap", "normalmap", parse_normalmap},
    {"bumpmap", "bumpmap", parse_bumpmap},
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
    importer.context().attempt(object, [&] {
        Bsdf made = type->parse(importer, object);
        made.place = place;
        made.check_count();
        bsdf = std::move(made);
    });
    object.finish();
}

} // namespace opal::mitsuba
