// What MTL's materials mean, and what Opal renders of them. Blender's exporter was measured (5.0.1); what it makes of
// Ns, Ka and illum holds for its files alone.
#include "read/mtl.h"

#include "base/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace opal {

namespace {

constexpr double default_kd = 0.8;   // what readers agree on best
constexpr double max_exponent = 1e5; // of a Phong lobe: about a mirror; single precision holds it well

double grey_of(const Color &c) { return (c[0] + c[1] + c[2]) / 3; }
double largest_of(const Color &c) { return *std::max_element(c.begin(), c.end()); }

// Statements of a material with defaults.
class Statements {
public:
    explicit Statements(const MtlMaterial &material) : material_(material) {}

    bool has(const char *name) const { return material_.colors.contains(name) || material_.numbers.contains(name); }
    bool has_texture(const char *name) const { return material_.textures.contains(name); }
    Color color(const char *name, double grey) const {
        const auto found = material_.colors.find(name);
        return found == material_.colors.end() ? Color{grey, grey, grey} : found->second;
    }
    double number(const char *name, double otherwise) const {
        const auto found = material_.numbers.find(name);
        return found == material_.numbers.end() ? otherwise : found->second;
    }

private:
    const MtlMaterial &material_;
};

double square(double x) { return x * x; }

// Blender writes Ns = 1000 (1 - r)^2 and, with its PBR extensions, r itself.
double blender_roughness(const Statements &of) {
    return of.has("pr") ? of.number("pr", 0.5) : 1 - std::sqrt(std::min(of.number("ns", 250), 1000.0) / 1000);
}

void add_blender_layers(const Statements &of, PrincipledMaterial &material) {
    material.roughness = blender_roughness(of);
    const double illum = of.number("illum", 2);
    const bool is_metal = illum == 3 || (illum == 6 && material.opacity < 1);
    material.metallic = of.has("pm") ? of.number("pm", 0) : is_metal ? grey_of(of.color("ka", 0)) : 0;
    const double level = grey_of(of.color("ks", 0));
    material.f0 = 2 * level * square((material.ior - 1) / (material.ior + 1));
    material.transmission = grey_of(of.color("tf", 0));
    material.coat = of.number("pc", 0) / 4;
}

void add_other_layers(const Statements &of, PrincipledMaterial &material) {
    const double illum = of.number("illum", 2);
    const Color specular = of.color("ks", 0);
    material.metallic = of.number("pm", 0);
    if (of.has("pr")) {
        material.roughness = of.number("pr", 0.5);
        material.f0 = square((material.ior - 1) / (material.ior + 1));
    } else if (of.number("ns", 0) > 0 && largest_of(specular) > 0 && illum != 0 && illum != 1) {
        material.phong = specular;
        material.phong_exponent = of.number("ns", 0);
        material.roughness = std::pow(2 / (material.phong_exponent + 2), 0.25); // alpha is sqrt(2 / (Ns + 2))
    }
    const bool says_glass = illum == 4 || illum == 6 || illum == 7 || illum == 9;
    if (of.has("tf") && (says_glass || of.has("pr"))) {
        material.transmission = grey_of(of.color("tf", 0));
        if (!of.has("pr") && material.phong_exponent == 0)
            material.roughness = 0;                         // nothing says how rough the glass is
        if (!of.has("pr") && material.transmission > 0.5) { // clear glass, whose Kd is often black
            material.transmission = 1;
            material.base = {1, 1, 1};
        }
    }
    material.coat = of.number("pc", 0);
}

Bsdf twosided(const Bsdf &base) {
    Bsdf bsdf = bsdf_twosided_record{};
    bsdf.children.push_back(base);
    return bsdf;
}

ColorParameter parameter_of(const Color &c) { return {c[0], c[1], c[2]}; }
Color scaled(const Color &c, double by) { return {c[0] * by, c[1] * by, c[2] * by}; }

Bsdf diffuse_of(const Color &albedo) {
    bsdf_diffuse_record diffuse;
    diffuse.albedo = parameter_of(albedo);
    return diffuse;
}

// A diffuse part and a lobe, whose shares follow from their reflectances: each stays what it is, at most 1 in all.
Bsdf phong_of(const Color &diffuse, Color specular, double exponent, std::vector<std::string> &lacking) {
    const double kd = largest_of(diffuse);
    if (const double rest = 1 - std::min(kd, 1.0), ks = largest_of(specular); ks > rest) {
        lacking.push_back(
            fmt::format("Ks {:g} beside Kd {:g}, which reflect more than all light: Ks becomes {:g}", ks, kd, rest));
        specular = scaled(specular, rest / ks);
    }
    const double ks = largest_of(specular);
    const double share = ks > 0 ? kd / (kd + ks) : 1;
    if (static_cast<float>(share) == 1) // the lobe would never be drawn
        return diffuse_of(diffuse);
    bsdf_phong_record phong;
    phong.pd = share;
    phong.kd = parameter_of(share > 0 ? scaled(diffuse, 1 / share) : Color{});
    phong.ks = parameter_of(scaled(specular, 1 / (1 - share)));
    phong.n = std::min(exponent, max_exponent);
    return phong;
}

// Clear layer over a diffuse base: the index of refraction gives f0 against air of index 1.
Bsdf microfacet_of(const Color &base, double f0, double roughness) {
    const double root = std::sqrt(std::min(f0, 0.99));
    bsdf_microfacet_record microfacet;
    microfacet.kd = parameter_of(base);
    microfacet.alpha = square(roughness);
    microfacet.int_ior = (1 + root) / (1 - root);
    microfacet.ext_ior = 1;
    return microfacet;
}

// Disney's material: metal, rough glass, a coat or a sheen on a base.
Bsdf disney_of(const PrincipledMaterial &material, std::vector<std::string> &lacking) {
    constexpr double least_index = 1.001;   // at 1 facets reflect nothing, of metal neither
    constexpr double strongest_coat = 0.25; // of Disney's clear coat
    const double root = std::sqrt(std::min(material.f0, 0.99));
    const double index = material.transmission > 0 ? material.ior : (1 + root) / (1 - root);
    if (material.coat > strongest_coat)
        lacking.push_back(fmt::format("coat {:g}, which becomes {:g}", material.coat, strongest_coat));
    Color base = material.base;
    for (double &channel : base)
        channel = std::min(channel, 1.0);
    bsdf_principled_record principled;
    principled.base_color = parameter_of(base);
    principled.roughness = material.roughness;
    principled.anisotropic = std::clamp(material.anisotropic, 0.0, 1.0);
    principled.metallic = std::min(material.metallic, 1.0);
    principled.spec_trans = std::min(material.transmission, 1.0);
    principled.eta = index == 1 ? least_index : index;
    principled.sheen = std::min(material.sheen, 1.0);
    principled.clearcoat = std::min(material.coat / strongest_coat, 1.0);
    // Disney's gloss takes the coat's alpha from 0.1 to 0.001.
    principled.clearcoat_gloss = std::clamp((0.1 - square(material.coat_roughness)) / (0.1 - 0.001), 0.0, 1.0);
    return principled;
}

Bsdf bsdf_of(const PrincipledMaterial &material, std::vector<std::string> &lacking) {
    const bool is_white = !material.base_texture && *std::min_element(material.base.begin(), material.base.end()) >= 1;
    if (material.transmission >= 1 && material.metallic == 0 && material.roughness == 0 && is_white) {
        bsdf_dielectric_record glass;
        glass.int_ior = material.ior;
        glass.ext_ior = 1;
        return glass;
    }
    if (material.metallic >= 1 && material.roughness == 0 && is_white)
        return twosided(bsdf_mirror_record{});
    if (material.transmission > 0)
        return disney_of(material, lacking);
    if (material.metallic > 0 || material.coat > 0 || material.sheen > 0)
        return twosided(disney_of(material, lacking));
    if (largest_of(material.phong) > 0)
        return twosided(phong_of(material.base, material.phong, material.phong_exponent, lacking));
    if (material.f0 > 0 && (largest_of(material.base) < 1 || material.base_texture))
        return twosided(microfacet_of(material.base, material.f0, material.roughness));
    return twosided(diffuse_of(material.base));
}

// Puts the texture onto the colours that the base colour is in.
void add_base_texture(const PrincipledMaterial &material, Bsdf &bsdf, std::vector<std::string> &lacking) {
    Bsdf &base = bsdf.children.empty() ? bsdf : bsdf.children.front();
    bool is_used = false;
    for (const Parameter &parameter : bsdf_parameters(base.kind()))
        if (parameter.name == "albedo" || parameter.name == "kd" || parameter.name == "base_color" ||
            (parameter.name == "ks" && material.metallic > 0)) {
            base.textures.emplace(parameter.texture_word, *material.base_texture);
            is_used = true;
        }
    if (!is_used)
        lacking.push_back(fmt::format("the picture of the colour of a {}", bsdf_name(base.kind())));
}

// A surface of which light meets a share.
Bsdf mask_of(const Bsdf &base, double opacity, const std::optional<Texture> &texture) {
    Bsdf bsdf = bsdf_mask_record{.opacity = opacity};
    bsdf.children.push_back(base);
    if (texture)
        bsdf.textures.emplace(find_row(bsdf_parameters(BSDF_mask), "parameter", "opacity").texture_word, *texture);
    return bsdf;
}

void set_place(Bsdf &bsdf, const SourcePlace &place) {
    bsdf.place = place;
    for (Bsdf &child : bsdf.children)
        set_place(child, place);
}

std::string text_of(const Color &c) { return fmt::format("{:g} {:g} {:g}", c[0], c[1], c[2]); }

// The textures of a material that are rendered, as surface_of has them.
class MaterialTextures {
public:
    MaterialTextures(const MtlMaterial &material, const TextureReader &read) : material_(material), read_(read) {}

    // Nothing where no statement of that name is written, or its image cannot be read.
    std::optional<Texture> take(const char *statement, const std::string &instead) {
        const auto found = material_.textures.find(statement);
        if (found == material_.textures.end() || !read_)
            return std::nullopt;
        taken_.insert(statement);
        return read_(found->second, instead);
    }
    bool has_taken(const std::string &statement) const { return taken_.contains(statement); }

private:
    const MtlMaterial &material_;
    const TextureReader &read_;
    std::set<std::string> taken_;
};

} // namespace

PrincipledMaterial principled_of(const MtlMaterial &written) {
    const Statements of(written);
    PrincipledMaterial material;
    material.base = of.color("kd", of.has_texture("map_kd") ? 1 : default_kd);
    material.ior = of.number("ni", 1.5);
    material.opacity = of.number("d", 1);
    material.emission = of.color("ke", of.has_texture("map_ke") ? 1 : 0);
    material.sheen = of.number("ps", 0);
    material.anisotropic = of.number("aniso", 0);
    material.coat_roughness = of.number("pcr", material.coat_roughness);
    if (written.by_blender)
        add_blender_layers(of, material);
    else
        add_other_layers(of, material);
    material.roughness = std::min(material.roughness, 1.0);
    return material;
}

SurfaceOfMaterial surface_of(const MtlMaterial &written, const TextureReader &read) {
    PrincipledMaterial material = principled_of(written);
    MaterialTextures textures(written, read);
    const Color without = Statements(written).color("kd", default_kd);
    material.base_texture = textures.take("map_kd", fmt::format("Kd {} stands in for it", text_of(without)));
    if (textures.has_taken("map_kd") && !material.base_texture)
        material.base = without;
    SurfaceOfMaterial surface;
    surface.bsdf = bsdf_of(material, surface.lacking);
    if (material.base_texture)
        add_base_texture(material, surface.bsdf, surface.lacking);
    surface.is_invisible = material.opacity == 0;
    const bool is_glass = surface.bsdf.is<bsdf_dielectric_record>();
    std::optional<Texture> opacity;
    if (const auto map = written.textures.find("map_d"); map != written.textures.end() && !is_glass) {
        const auto base = written.textures.find("map_kd");
        if (base == written.textures.end() || base->second.file != map->second.file) // that means its alpha
            opacity = textures.take("map_d", fmt::format("d {:g} stands in for it", material.opacity));
    }
    if (opacity)
        if (auto *picture = std::get_if<BitmapTexture>(&*opacity))
            picture->raw = true; // numbers, no colours
    if (is_glass && material.opacity < 1 && material.opacity > 0)
        surface.lacking.push_back(fmt::format("opacity {:g} of glass", material.opacity));
    else if (opacity || (material.opacity > 0 && material.opacity < 1))
        surface.bsdf = mask_of(surface.bsdf, material.opacity, opacity);
    set_place(surface.bsdf, written.place);
    if (largest_of(material.emission) > 0)
        surface.radiance = material.emission;
    if (material.anisotropic != 0 && material.metallic == 0 && material.transmission == 0)
        surface.lacking.push_back("anisotropy of what is neither metal nor glass");
    for (const auto &[statement, texture] : written.textures)
        if (!textures.has_taken(statement))
            surface.lacking.push_back(fmt::format(
                "{} {}{}", texture.statement, texture.file,
                statement == "map_ke" && written.by_blender ? ", whose strength Blender has not written" : ""));
    return surface;
}

} // namespace opal
