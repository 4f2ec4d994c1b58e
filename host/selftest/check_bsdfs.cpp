// Every BSDF: samples against the density, weights against values, reciprocity, energy, and what discrete ones must do.
#include "selftest/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace opal {

namespace {

constexpr double weight_rounding = 1e-6; // weights are floats

// The unit direction at `degrees` to the normal; azimuth in radians.
Vec3 direction_at(double degrees, double azimuth = 0.3) {
    const double theta = degrees * std::numbers::pi / 180;
    return stats::spherical_direction(std::cos(theta), azimuth);
}

Planes random_numbers(KernelProbe &probe, size_t count, unsigned seed) {
    NumberOptions which;
    which.seed = seed;
    return probe.numbers(count, which);
}

// Sample i went in a single direction, which f and pdf know nothing of.
bool is_discrete_sample(const Planes &drawn, size_t i) { return drawn.at(BSDF_DISCRETE, i) != 0; }

// Sample i went nowhere: its lobe sent it to a side where it reflects nothing. Another lobe may have a density there.
bool is_failed_sample(const Planes &drawn, size_t i) {
    return drawn.at(BSDF_PDF, i) == 0 && length(drawn.vec3(BSDF_WEIGHT_R, i)) == 0;
}

// Whether sample i has the weight f cos / pdf in every channel and the density that the BSDF (f) gives its direction,
// to 2 %. Directions are rounded: the half vector of one is off by some 2^-24 / (wi . h), which Beckmann's density
// magnifies by 2 tan / alpha^2.
bool sample_fits(const Planes &drawn, const Planes &f, size_t i) {
    const double cosine = std::abs(drawn.at(BSDF_WO_Z, i)), pdf = f.at(EVAL_PDF, i);
    bool fits = std::abs(drawn.at(BSDF_PDF, i) - pdf) <= 2e-2 * pdf;
    for (size_t c = 0; c < 3; c++) {
        const double weight = drawn.at(BSDF_WEIGHT_R + c, i), ratio = pdf > 0 ? f.at(EVAL_R + c, i) * cosine / pdf : 0;
        fits = fits && std::abs(ratio - weight) <= 2e-2 * weight;
    }
    return fits;
}

Findings check_each_sample(const Planes &drawn, const Planes &f, const std::string &subject) {
    double wrong = 0;
    stats::Moments density_errors;
    for (size_t i = 0; i < drawn.count; i++) {
        if (is_discrete_sample(drawn, i) || is_failed_sample(drawn, i))
            continue;
        const double pdf = f.at(EVAL_PDF, i), own = drawn.at(BSDF_PDF, i);
        wrong += !sample_fits(drawn, f, i);
        density_errors.add(pdf > 0 ? std::abs(own / pdf - 1) : own);
    }
    return {at_most("BSDFs: share of samples unlike f cos / pdf", wrong / double(drawn.count), 1 / 512.0, subject),
            at_most("BSDFs: a sample's density against the BSDF's, off by", density_errors.mean(), 1e-4, subject)};
}

// f cos / pdf, recomputed from the drawn direction (which rounds its half vector), against the sample's weight, on
// average; and the mean weight less 5 standard errors.
Findings check_samples(KernelProbe &probe, unsigned id, Vec3 wi, const std::string &subject, const Effort &effort) {
    const Planes of_power = probe.bsdf_sample(id, wi, random_numbers(probe, effort.draws, effort.seed + 77));
    const Planes drawn = of_radiance(of_power); // as f is
    std::vector<Vec3> wos;
    for (size_t i = 0; i < drawn.count; i++)
        wos.push_back(drawn.vec3(BSDF_WO_X, i));
    const Planes f = probe.bsdf_eval(id, wi, wos);
    double energy = 0, weight_error = 0;
    for (size_t c = 0; c < 3; c++) {
        stats::Moments weights, differences;
        for (size_t i = 0; i < drawn.count; i++) {
            const double weight = drawn.at(BSDF_WEIGHT_R + c, i), pdf = drawn.at(BSDF_PDF, i);
            weights.add(of_power.at(BSDF_WEIGHT_R + c, i));
            if (weight > 0 && !is_discrete_sample(drawn, i))
                differences.add(std::abs(f.at(EVAL_R + c, i) * std::abs(wos[i].z) / (pdf * weight) - 1));
        }
        weight_error = worst_of(weight_error, differences.mean());
        energy = worst_of(energy, weights.mean() - 5 * std::sqrt(weights.variance_of_mean()) - weight_rounding);
    }
    Findings findings = {at_most("BSDFs: albedo less 5 standard errors", energy, 1, subject),
                         at_most("BSDFs: weight against f cos / pdf, off by", weight_error, 1e-4, subject)};
    if (effort.each_sample)
        append(findings, check_each_sample(drawn, f, subject));
    return findings;
}

// The eta of the samples that pass from wi's side to the other one, squared; 1 where there are none.
double passing_eta2(KernelProbe &probe, unsigned id, Vec3 from) {
    const Vec3 wi{0, 0, std::copysign(1, from.z)}; // from which most pass
    const Planes drawn = probe.bsdf_sample(id, wi, random_numbers(probe, 64, 0));
    for (size_t i = 0; i < drawn.count; i++)
        if (drawn.at(BSDF_WO_Z, i) * wi.z < 0 && !is_discrete_sample(drawn, i) && !is_failed_sample(drawn, i))
            return double(drawn.at(BSDF_ETA, i)) * drawn.at(BSDF_ETA, i);
    return 1;
}

// f(a, b) eta^2 = f(b, a), with eta the index of b's side over that of a's side (Veach 1997, section 5.2).
Finding check_reciprocity(KernelProbe &probe, unsigned id, Vec3 wi, const std::string &subject) {
    std::vector<Vec3> wos;
    for (double degrees : {0.0, 20.0, 50.0, 75.0, 120.0, 160.0})
        for (double azimuth : {0.3, 2.0, 3.3})
            wos.push_back(direction_at(wi.z > 0 ? degrees : 180 - degrees, azimuth));
    const double eta2 = passing_eta2(probe, id, wi);
    const Planes there = probe.bsdf_eval(id, wi, wos);
    double error = 0;
    for (size_t i = 0; i < wos.size(); i++) {
        const Planes back = probe.bsdf_eval(id, wos[i], std::span(&wi, 1));
        for (size_t c = 0; c < 3; c++) {
            const double a = there.at(EVAL_R + c, i) * (wos[i].z * wi.z < 0 ? eta2 : 1), b = back.at(EVAL_R + c, 0);
            error = worst_of(error, std::abs(a - b) / std::max({a, b, 1e-30}));
        }
    }
    return at_most("BSDFs: f(a, b) against f(b, a), off by", error, 1e-4, subject);
}

Finding check_corners(KernelProbe &probe, unsigned id, Vec3 wi, const std::string &subject) {
    const Planes drawn = probe.bsdf_sample(id, wi, corner_numbers());
    double invalid = 0;
    for (size_t i = 0; i < drawn.count; i++)
        for (size_t plane = 0; plane < BSDF_PLANES; plane++)
            invalid += !std::isfinite(drawn.at(plane, i));
    return none_wrong("BSDFs: not finite at corners", invalid, subject);
}

// Whether some of the light that meets the back has a density.
bool is_seen_from_behind(KernelProbe &probe, unsigned id) {
    const Planes drawn = probe.bsdf_sample(id, direction_at(130), random_numbers(probe, 64, 0));
    bool seen = false;
    for (size_t i = 0; i < drawn.count; i++)
        for (size_t c = 0; c < 3; c++)
            seen = seen || (drawn.at(BSDF_WEIGHT_R + c, i) > 0 && !is_discrete_sample(drawn, i));
    return seen;
}

// A boundary between two media, seen from wi: indices of refraction on that side and beyond. Nothing for kinds whose
// law is not known here.
struct Boundary {
    double near, far;
    double reflected, refracted; // factors of what is, of red light
};
std::optional<Boundary> boundary_of(const Bsdf &bsdf, Vec3 wi) {
    if (!bsdf.is<bsdf_dielectric_record>())
        return {};
    const auto dielectric = bsdf.as<bsdf_dielectric_record>();
    const double inside = dielectric.int_ior.value, outside = dielectric.ext_ior.value;
    const double reflected = dielectric.specular_reflectance.value[0],
                 refracted = dielectric.specular_transmittance.value[0];
    return wi.z > 0 ? Boundary{outside, inside, reflected, refracted} : Boundary{inside, outside, reflected, refracted};
}

// Where sample i goes, off from the mirrored direction or from the one that is refracted by the eta it states.
double direction_error(const Planes &drawn, size_t i, Vec3 wi) {
    const Vec3 wo = drawn.vec3(BSDF_WO_X, i);
    if (wo.z * wi.z > 0)
        return length(wo - Vec3{-wi.x, -wi.y, wi.z});
    const double eta = drawn.at(BSDF_ETA, i);
    const double cosine = std::sqrt(1 - (wi.x * wi.x + wi.y * wi.y) / (eta * eta));
    return length(wo - Vec3{-wi.x / eta, -wi.y / eta, -std::copysign(cosine, wi.z)});
}

// What all samples of a boundary carry, which is all power but for the factors, and the eta of those that are
// refracted.
double boundary_error(const Planes &drawn, size_t i, Vec3 wi, const Boundary &boundary) {
    const bool refracted = drawn.at(BSDF_WO_Z, i) * wi.z < 0;
    const double eta = refracted ? boundary.far / boundary.near : 1;
    const double weight = refracted ? boundary.refracted : boundary.reflected;
    return std::max(std::abs(double(drawn.at(BSDF_WEIGHT_R, i)) - weight), std::abs(drawn.at(BSDF_ETA, i) / eta - 1));
}

// From both sides: where a discrete BSDF sends light, with which weight, and how often it reflects.
Findings check_discrete(KernelProbe &probe, unsigned id, const Material &material, const Effort &effort) {
    const Planes numbers = random_numbers(probe, effort.draws, effort.seed + 99);
    Findings findings;
    for (double degrees : {1.0, 40.0, 60.0, 80.0, 100.0, 120.0, 150.0, 179.0}) {
        const std::string subject = fmt::format("{} at {:g} degrees", material.name, degrees);
        const Vec3 wi = direction_at(degrees);
        const std::optional<Boundary> boundary = boundary_of(material.bsdf, wi);
        const Planes drawn = probe.bsdf_sample(id, wi, numbers);
        double error = 0, reflected = 0;
        stats::Moments weights;
        for (size_t i = 0; i < drawn.count; i++) {
            weights.add(drawn.at(BSDF_WEIGHT_R, i));
            reflected += drawn.at(BSDF_WO_Z, i) * wi.z > 0;
            if (drawn.at(BSDF_WEIGHT_R, i) > 0)
                error = worst_of(error, direction_error(drawn, i, wi));
            if (boundary)
                error = worst_of(error, boundary_error(drawn, i, wi, *boundary));
            if (material.bsdf.is<bsdf_mirror_record>())
                error = worst_of(error, std::abs(drawn.at(BSDF_WEIGHT_R, i) - (wi.z > 0)));
        }
        findings.push_back(at_most("mirror, dielectric: direction and weight, off by", error, 3e-5, subject));
        const double albedo = weights.mean() - 5 * std::sqrt(weights.variance_of_mean()) - weight_rounding;
        findings.push_back(at_most("BSDFs: albedo less 5 standard errors", albedo, 1, subject));
        if (!boundary)
            continue;
        const double reflectance = fresnel_reflectance(std::abs(wi.z), boundary->near, boundary->far);
        if (reflectance < 1) // at total reflection rounding may leave a little to refraction
            findings.push_back(p_value("dielectric: reflectance, smallest p",
                                       stats::binomial_test(reflected, double(drawn.count), reflectance).p_value,
                                       subject));
    }
    return findings;
}

} // namespace

double fresnel_reflectance(double cosine, double near, double far) {
    const double sine = near / far * std::sqrt(1 - cosine * cosine);
    if (sine >= 1)
        return 1;
    const double other = std::sqrt(1 - sine * sine);
    const double s = (near * cosine - far * other) / (near * cosine + far * other),
                 p = (far * cosine - near * other) / (far * cosine + near * other);
    return (s * s + p * p) / 2;
}

Findings material_findings(KernelProbe &probe, const std::vector<Material> &materials, const Effort &effort) {
    Findings findings;
    unsigned seed = effort.seed;
    for (unsigned id = 0; id < materials.size(); id++) {
        const bool discrete = is_discrete(materials[id].bsdf);
        std::vector<double> angles = effort.angles;
        if (!discrete && is_seen_from_behind(probe, id))
            angles.push_back(130);
        for (double angle : angles) {
            const Vec3 wi = direction_at(angle);
            const std::string subject = fmt::format("{} at {:g} degrees", materials[id].name, angle);
            if (!discrete) {
                const DensityCheck check =
                    check_density(probe, sampled_bsdf(probe, id, wi), effort.nu, effort.nv, effort.samples, ++seed);
                findings.push_back(
                    p_value("BSDFs: samples against density, smallest p", check.test.result.p_value, subject));
                append(findings, check_samples(probe, id, wi, subject, effort));
                // A changed normal has another cosine; a thin sheet loses some light more one way than the other.
                if (!(materials[id].bsdf.traits() & OPAL_PERTURBS) &&
                    !materials[id].bsdf.is<bsdf_principledthin_record>())
                    findings.push_back(check_reciprocity(probe, id, wi, subject));
            }
            findings.push_back(check_corners(probe, id, wi, subject));
        }
        if (discrete)
            append(findings, check_discrete(probe, id, materials[id], effort));
    }
    return findings;
}

Findings run_bsdfs(const Device &device, const SelftestOptions &options) {
    const std::vector<Material> &materials = selftest_materials();
    KernelProbe probe(device, scene_of_materials(materials), options.build, *options.sources);
    return summary_of(material_findings(probe, materials, effort_of(options)));
}

} // namespace opal
