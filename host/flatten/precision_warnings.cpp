#include "flatten/precision_warnings.h"

#include "flatten/emitter_kinds.h"
#include "flatten/plastic_boundary.h"
#include "scene/principled_albedo.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <numbers>

namespace opal {

namespace {

// Sizes are the longest sides of boxes, distances are in sizes of the scene.
constexpr double min_mesh_size = 2e-3; // a mesh of this size is rendered right to about 1e-5
constexpr double max_camera_distance = 1e3;
constexpr double float_spacing = 1.2e-7; // of neighbouring floats, relative: 2^-23
constexpr double ray_offset = 1.4e-6;    // of a ray's origin from its surface: 24 * 2^-24, as in surface.cl
constexpr float min_alpha = 1e-6f, max_phong_exponent = 1e8f; // the ends of the tested ranges
constexpr double min_radiance = 1e-18, max_radiance = 1e18;   // the film sums squares in float

float largest(const ColorParameter &color) { return std::max({color.value[0], color.value[1], color.value[2]}); }

class Checker {
public:
    Checker(const SceneDescription &scene, const FlatScene &flat)
        : scene_(scene), flat_(flat), extent_(extent_of(scene)) {}

    std::vector<std::string> run() {
        const double size = extent_.longest_side(),
                     away = size > 0 ? length(scene_.camera.to_world.point({}) - extent_.middle()) / size : 0;
        if (away > max_camera_distance)
            add_warning(
                scene_.camera.place,
                "the camera is {:.2g} sizes of the scene away: its rays start where floats lie {:.1g} of that size "
                "apart",
                away, away * float_spacing);
        for (size_t i = 0; i < scene_.meshes.size(); i++) {
            const Mesh &mesh = scene_.meshes[i];
            check_size(mesh);
            if (mesh.radiance)
                check_light(mesh, *std::max_element(mesh.radiance->begin(), mesh.radiance->end()),
                            flat_.meshes[i].emitter != OPAL_NONE);
            check_bsdf(mesh.bsdf, mesh.bsdf.place.line ? mesh.bsdf.place : mesh.place);
        }
        check_lights();
        for (const auto &[text, kind] : kinds_)
            if (kind.count > most_told)
                lines_[kind.last] += fmt::format(" (and {} more like this)", kind.count - most_told);
        return std::move(lines_);
    }

private:
    static constexpr size_t most_told = 20; // of one kind: a scene may have a million of them
    struct Kind {
        size_t count = 0, last = 0; // the warnings, and the index of the last one in lines_
    };
    const SceneDescription &scene_;
    const FlatScene &flat_;
    const Extent extent_;
    std::vector<std::string> lines_;
    std::map<std::string_view, Kind> kinds_; // by their text before the numbers are put in

    template <class... Arguments>
    void add_warning(const SourcePlace &place, fmt::format_string<Arguments...> text, Arguments &&...arguments) {
        const fmt::string_view form = text;
        Kind &kind = kinds_[{form.data(), form.size()}];
        if (++kind.count > most_told)
            return;
        kind.last = lines_.size();
        lines_.push_back(place.text() + ": " + fmt::format(text, std::forward<Arguments>(arguments)...));
    }

    void check_size(const Mesh &mesh) {
        const double part = extent_of(mesh).longest_side() / extent_.longest_side();
        if (part > 0 && part < min_mesh_size)
            add_warning(
                mesh.place,
                "{} is {:.1e} of the scene's size: rays start {:.1g} of its own size above it, what is seen of it may "
                "be off by more than 1e-5, and rays "
                "may pass what is nearer",
                mesh.name, part, ray_offset / part);
    }

    void check_light(const Mesh &mesh, double radiance, bool emits) {
        if (radiance > 0 && !emits)
            add_warning(mesh.place, "an area light of no area, in single precision: it emits nothing");
        if (radiance > max_radiance || (radiance > 0 && radiance < min_radiance))
            add_warning(
                mesh.place,
                "radiance {:.1e}: the image holds it, but its squares leave the range of floats, and with them the "
                "error bars",
                radiance);
    }

    // Flattening multiplies intensities by the square of its scale.
    void check_lights() {
        size_t i = flat_.emitters.size(); // the lights are the last emitters, in their order, without the black ones
        for (auto light = scene_.lights.rbegin(); light != scene_.lights.rend(); ++light) {
            if (is_black(*light))
                continue;
            const auto &color = flat_.emitters[--i].u.color;
            const bool is_lost = std::ranges::all_of(color, [](float channel) { return channel == 0; });
            if (is_lost || !std::ranges::all_of(color, [](float channel) { return std::isfinite(channel); }))
                add_warning(light->place, "this light leaves the range of floats in a scene of size {:.1e}: {}",
                            extent_.longest_side(), is_lost ? "it emits nothing" : "the image is wrong");
        }
    }

    void check_bsdf(const Bsdf &bsdf, const SourcePlace &place) {
        for (const Bsdf &child : bsdf.children)
            check_bsdf(child, child.place.line ? child.place : place);
        switch (bsdf.kind()) {
        case BSDF_diffuse:
            return check(bsdf.as<bsdf_diffuse_record>(), place);
        case BSDF_dielectric:
            return check(bsdf.as<bsdf_dielectric_record>(), place);
        case BSDF_thindielectric:
            return check(bsdf.as<bsdf_thindielectric_record>(), place);
        case BSDF_roughconductor:
        case BSDF_roughdielectric:
        case BSDF_roughplastic:
            return check_facets(bsdf, place);
        case BSDF_plastic:
            return check(bsdf.as<bsdf_plastic_record>(), place);
        case BSDF_microfacet:
            return check(bsdf.as<bsdf_microfacet_record>(), place);
        case BSDF_phong:
            return check(bsdf.as<bsdf_phong_record>(), place);
        case BSDF_principled:
            return check_principled(bsdf, place);
        case BSDF_principledthin:
            return check(bsdf.as<bsdf_principledthin_record>(), place);
        }
    }

    void check(const bsdf_diffuse_record &diffuse, const SourcePlace &place) {
        if (const float albedo = largest(diffuse.albedo); albedo > 1)
            add_warning(place, "albedo {:g} is above 1: more light leaves than comes, and paths may grow for ever",
                        albedo);
    }

    // A boundary between two media: a dielectric, or a thin one.
    template <class Boundary> void check(const Boundary &dielectric, const SourcePlace &place) {
        if (dielectric.int_ior.value == dielectric.ext_ior.value)
            add_warning(place, "intIOR and extIOR are both {:g}: the surface cannot be seen, and costs a bounce",
                        dielectric.int_ior.value);
    }

    void check_facets(const Bsdf &bsdf, const SourcePlace &place) {
        for (const char *name : {"alpha", "alpha_u", "alpha_v"})
            if (const Parameter *const parameter = bsdf_parameter(bsdf.kind(), name))
                if (const float alpha = std::bit_cast<float>(bsdf.words[parameter->word]); alpha < LEAST_ALPHA)
                    add_warning(place,
                                "{} {:g} is below {:g}, the least roughness that was tested: that stands in for it",
                                name, alpha, LEAST_ALPHA);
    }

    // The fit of the reflectance from inside leaves the base too much light.
    void check(const bsdf_plastic_record &plastic, const SourcePlace &place) {
        constexpr double told = 1.002; // up to an index of 2 even a white base stays below it
        if (plastic.int_ior.value == plastic.ext_ior.value)
            add_warning(place, "intIOR and extIOR are both {:g}: the coat reflects nothing", plastic.int_ior.value);
        const double eta = double(plastic.ext_ior.value) / plastic.int_ior.value;
        const double albedo = largest(plastic.diffuse_reflectance);
        const double back = (plastic.nonlinear ? albedo : 1) * diffuse_reflectance_fit(eta);
        const double leaving = albedo * (1 - diffuse_reflectance(eta)) / (1 - back);
        if (leaving > told)
            add_warning(place,
                        "{:.3f} of the light that enters leaves, as in Mitsuba: its formula for light that is "
                        "reflected inside is a fit for indices below 2",
                        leaving);
    }

    void check(const bsdf_microfacet_record &microfacet, const SourcePlace &place) {
        if (microfacet.int_ior.value == microfacet.ext_ior.value)
            add_warning(place, "intIOR and extIOR are both {:g}: the coat reflects nothing", microfacet.int_ior.value);
        if (microfacet.alpha.value < min_alpha && microfacet.alpha.value >= MICROFACET_MIRROR_ALPHA)
            add_warning(
                place,
                "alpha {:g} is below {:g}, the least that was tested: a mirror or dielectric is what it looks like",
                microfacet.alpha.value, min_alpha);
    }

    // Of what adds to the light a texture counts as white; of metal and glass, which lose some, as black.
    void check_principled(const Bsdf &bsdf, const SourcePlace &place) {
        Bsdf brightest = bsdf;
        for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
            if ((parameter.name == "metallic" || parameter.name == "spec_trans") &&
                bsdf.textures.contains(parameter.texture_word))
                brightest.words[parameter.word] = 0; // the number 0
        check_gain(place, brightest.as<bsdf_principled_record>());
    }

    // The base of a thin sheet reflects as that of principled does; what it transmits, and its facets, add at most the
    // colour.
    void check(const bsdf_principledthin_record &thin, const SourcePlace &place) {
        const float share = (1 - thin.spec_trans.value) * (1 - thin.diff_trans.value / 2);
        check_gain(place,
                   {.base_color = thin.base_color,
                    .roughness = thin.roughness,
                    .eta = 1,
                    .sheen = thin.sheen,
                    .sheen_tint = thin.sheen_tint,
                    .flatness = thin.flatness},
                   share, (1 - share) * largest(thin.base_color));
    }

    void check_gain(const SourcePlace &place, const bsdf_principled_record &principled, double share = 1,
                    double more = 0) {
        constexpr int points = 48; // of a quadrature, for each lobe
        double most = 0, at = 0;
        for (double degrees : {0., 45., 70., 80., 85., 88.})
            for (double azimuth : {0., 90.}) {
                const double theta = degrees * std::numbers::pi / 180, phi = azimuth * std::numbers::pi / 180;
                const Vec3 wi{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
                const Color albedo = principled_albedo(principled, wi, points);
                if (const double sum = share * *std::ranges::max_element(albedo) + more; sum > most) {
                    most = sum;
                    at = degrees;
                }
            }
        if (most > 1)
            add_warning(place,
                        "{:.2f} of the light that comes at {:g} degrees to the normal leaves, as in Mitsuba: the lobes "
                        "are added without regard to each other, and paths among such surfaces may grow",
                        most, at);
    }

    void check(const bsdf_phong_record &phong, const SourcePlace &place) {
        const float pd = phong.pd.value, reflected = pd * largest(phong.kd) + (1 - pd) * largest(phong.ks);
        if (reflected > 1)
            add_warning(place,
                        "kd and ks reflect {:g}, above 1: more light leaves than comes, and paths may grow for ever",
                        reflected);
        if (phong.n.value > max_phong_exponent)
            add_warning(place, "n {:g} is above {:g}, the most that was tested: a mirror is what it looks like",
                        phong.n.value, max_phong_exponent);
    }
};

} // namespace

std::vector<std::string> precision_warnings(const SceneDescription &scene, const FlatScene &flat) {
    return Checker(scene, flat).run();
}

} // namespace opal
