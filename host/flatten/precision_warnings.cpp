#include "flatten/precision_warnings.h"

#include "flatten/geometry.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

constexpr double least_detail = 2e-3;   // of a mesh, the scene being 1: what is seen of it is right to about 1e-5
constexpr double farthest_camera = 1e3; // in sizes of the scene
constexpr float least_alpha = 1e-6f, largest_exponent = 1e8f;
constexpr double largest_radiance = 1e18,
                 least_radiance = 1e-18; // their squares are summed in floats, for the error bars

float largest(const float (&color)[3]) { return std::max({color[0], color[1], color[2]}); }

class Checker {
public:
    Checker(const SceneDescription &of, const FlatScene &flattened)
        : scene(of), flat(flattened), extent(extent_of(of)) {}

    std::vector<std::string> run() {
        const double size = extent.longest_side(),
                     away = size > 0 ? length(scene.camera.to_world.point({}) - extent.middle()) / size : 0;
        if (away > farthest_camera)
            say(scene.camera.place,
                "the camera is {:.2g} sizes of the scene away: its rays start where floats lie {:.1g} of that size "
                "apart",
                away, away * 1.2e-7);
        for (size_t i = 0; i < scene.meshes.size(); i++) {
            const Mesh &mesh = scene.meshes[i];
            check_size(mesh);
            if (mesh.radiance)
                check_light(mesh, *std::max_element(mesh.radiance->begin(), mesh.radiance->end()),
                            flat.meshes[i].emitter != OPAL_NONE);
            check_bsdf(mesh.bsdf.record, mesh.bsdf.place.line ? mesh.bsdf.place : mesh.place);
        }
        return lines;
    }

private:
    const SceneDescription &scene;
    const FlatScene &flat;
    const Extent extent;
    std::vector<std::string> lines;

    template <class... Arguments>
    void say(const SourcePlace &place, fmt::format_string<Arguments...> text, Arguments &&...arguments) {
        lines.push_back(place.text() + ": " + fmt::format(text, std::forward<Arguments>(arguments)...));
    }

    void check_size(const Mesh &mesh) {
        const double part = extent_of(mesh).longest_side() / extent.longest_side();
        if (part > 0 && part < least_detail)
            say(mesh.place,
                "{} is {:.1e} of the scene's size: rays start {:.1g} of its own size above it, what is seen of it may "
                "be off by more than 1e-5, and rays "
                "may pass what is nearer",
                mesh.name, part, 1.4e-6 / part);
    }

    void check_light(const Mesh &mesh, double radiance, bool emits) {
        if (radiance > 0 && !emits)
            say(mesh.place, "an area light of no area, in single precision: it emits nothing");
        if (radiance > largest_radiance || (radiance > 0 && radiance < least_radiance))
            say(mesh.place,
                "radiance {:.1e}: the image holds it, but its squares leave the range of floats, and with them the "
                "error bars",
                radiance);
    }

    void check_bsdf(const BsdfRecord &record, const SourcePlace &place) {
        if (record.kind == BSDF_diffuse && largest(record.u.diffuse.albedo) > 1)
            say(place, "albedo {:g} is above 1: more light leaves than comes, and paths may grow for ever",
                largest(record.u.diffuse.albedo));
        if (record.kind == BSDF_dielectric && record.u.dielectric.int_ior == record.u.dielectric.ext_ior)
            say(place, "intIOR and extIOR are both {:g}: the surface cannot be seen, and costs a bounce",
                record.u.dielectric.int_ior);
        if (record.kind == BSDF_microfacet && record.u.microfacet.int_ior == record.u.microfacet.ext_ior)
            say(place, "intIOR and extIOR are both {:g}: the coat reflects nothing", record.u.microfacet.int_ior);
        if (record.kind == BSDF_microfacet && record.u.microfacet.alpha < least_alpha)
            say(place,
                "alpha {:g} is below {:g}, the least that was tested: a mirror or dielectric is what it looks like",
                record.u.microfacet.alpha, least_alpha);
        if (record.kind == BSDF_phong) {
            const PhongParams &p = record.u.phong;
            const float reflected = p.pd * largest(p.kd) + (1 - p.pd) * largest(p.ks);
            if (reflected > 1)
                say(place, "kd and ks reflect {:g}, above 1: more light leaves than comes, and paths may grow for ever",
                    reflected);
            if (p.n > largest_exponent)
                say(place, "n {:g} is above {:g}, the most that was tested: a mirror is what it looks like", p.n,
                    largest_exponent);
        }
    }
};

} // namespace

std::vector<std::string> sanity_warnings(const SceneDescription &scene, const FlatScene &flat) {
    return Checker(scene, flat).run();
}

} // namespace opal
