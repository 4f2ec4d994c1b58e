#include "scene/principled_albedo.h"

#include "scene/fresnel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opal {

namespace {

double square(double x) { return x * x; }
double mix(double a, double b, double share) { return a + share * (b - a); }
double schlick_weight(double cosine) { return std::pow(std::clamp(1 - cosine, 0., 1.), 5); }

// Fresnel's reflectance against an index, and the weight of Schlick's approximation to it.
struct DisneyFresnel : Fresnel {
    double weight;
    DisneyFresnel(double cosine, double eta)
        : Fresnel(cosine, eta), weight(schlick_weight(eta > 1 ? cosine : refracted)) {}
    double schlick(double at_normal) const { return mix(at_normal, 1, weight); }
};

// GGX facets.
struct Facets {
    double alpha_u, alpha_v;
    double stretched(Vec3 w) const { return std::hypot(alpha_u * w.x, alpha_v * w.y, w.z); }
    double masking(Vec3 w) const { return 2 * std::abs(w.z) / (std::abs(w.z) + stretched(w)); }
    // One that is visible from wi, by numbers in the unit square.
    Vec3 draw(Vec3 wi, double u, double v) const {
        const double length = stretched(wi), z = 1 - v * (1 + wi.z / length), sine = std::sqrt(1 - z * z);
        const double angle = 2 * std::numbers::pi * u;
        return normalize(Vec3{alpha_u * (sine * std::cos(angle) + alpha_u * wi.x / length),
                              alpha_v * (sine * std::sin(angle) + alpha_v * wi.y / length), z + wi.z / length});
    }
};

Vec3 direction(double sine2, double u) {
    const double sine = std::sqrt(sine2), angle = 2 * std::numbers::pi * u;
    return {sine * std::cos(angle), sine * std::sin(angle), std::sqrt(1 - sine2)};
}

// A channel of the BSDF.
class Channel {
public:
    Channel(const bsdf_principled_record &of, double base, double tint)
        : of_(of), base_(base), tint_(tint), opaque_((1 - of.metallic.value) * (1 - of.spec_trans.value)) {}

    double albedo(Vec3 wi, int points) const {
        double sum = 0;
        for (int i = 0; i < points; i++)
            for (int k = 0; k < points; k++) {
                const double u = (i + 0.5) / points, v = (k + 0.5) / points;
                sum += diffuse(wi, direction(v, u)) + faceted(wi, facets_.draw(wi, u, v)) + coated(wi, u, v);
            }
        return sum / square(points);
    }

private:
    const bsdf_principled_record &of_;
    double base_, tint_, opaque_;
    double aspect_ = std::sqrt(1 - 0.9 * of_.anisotropic.value), roughness_ = of_.roughness.value;
    Facets facets_{std::max(square(roughness_) / aspect_, 1e-3), std::max(square(roughness_) * aspect_, 1e-3)};

    double diffuse(Vec3 wi, Vec3 wo) const {
        if (opaque_ == 0)
            return 0;
        const double in = schlick_weight(wi.z), out = schlick_weight(wo.z), difference = dot(wo, normalize(wi + wo));
        const double retro = 2 * roughness_ * square(difference);
        const double rough = (1 - in / 2) * (1 - out / 2) + retro * (in + out + in * out * (retro - 1));
        const double flat = 1.25 * (mix(1, retro / 2, in) * mix(1, retro / 2, out) * (1 / (wi.z + wo.z) - 0.5) + 0.5);
        return opaque_ * base_ * mix(rough, flat, of_.flatness.value) +
               std::numbers::pi * (1 - of_.metallic.value) * of_.sheen.value * mix(1, tint_, of_.sheen_tint.value) *
                   schlick_weight(difference);
    }

    double faceted(Vec3 wi, Vec3 h) const {
        const double cosine = dot(wi, h), eta = of_.eta.value, glass = (1 - of_.metallic.value) * of_.spec_trans.value;
        if (cosine <= 0)
            return 0;
        const DisneyFresnel fresnel(cosine, eta);
        const Vec3 reflected = h * (2 * cosine) - wi,
                   refracted = h * (cosine / eta - fresnel.refracted) - wi * (1 / eta);
        const double dielectric =
            mix(fresnel.reflectance, fresnel.schlick(tint_ * square((eta - 1) / (eta + 1))), of_.spec_tint.value);
        const double back = eta != 1 ? mix(dielectric, fresnel.schlick(base_), of_.metallic.value) : 0;
        return (reflected.z > 0 ? back * facets_.masking(reflected) : 0) +
               (refracted.z < 0 ? glass * (1 - fresnel.reflectance) * std::sqrt(base_) * facets_.masking(refracted)
                                : 0);
    }

    double coated(Vec3 wi, double u, double v) const {
        const double strength = of_.clearcoat.value / 4, alpha2 = square(mix(0.1, 0.001, of_.clearcoat_gloss.value));
        const Vec3 h = direction(alpha2 * std::expm1(-v * std::log(alpha2)) / (1 - alpha2), u);
        const double cosine = dot(wi, h);
        const Vec3 wo = h * (2 * cosine) - wi;
        if (strength == 0 || cosine <= 0 || wo.z <= 0)
            return 0;
        const Facets shadows{0.25, 0.25};
        return strength * DisneyFresnel(cosine, of_.eta.value).schlick(0.04) * shadows.masking(wi) *
               shadows.masking(wo) * wo.z * 4 * cosine / h.z;
    }
};

} // namespace

Color principled_albedo(const bsdf_principled_record &bsdf, Vec3 wi, int points) {
    const auto &base = bsdf.base_color.value;
    const double brightness = luminance(Color{base[0], base[1], base[2]});
    Color albedo;
    for (size_t c = 0; c < 3; c++)
        albedo[c] = Channel(bsdf, base[c], brightness > 0 ? base[c] / brightness : 1).albedo(wi, points);
    return albedo;
}

} // namespace opal
