// Every BSDF: samples against the density, weights against values, reciprocity, energy, and what discrete ones must do.
#include "densities/sampled.h"
#include "selftest/selftest.h"

#include <cmath>
#include <numbers>
#include <random>

namespace opal {

namespace {

BsdfRecord diffuse_record(bool use_cosine) {
    BsdfRecord r{};
    r.kind = BSDF_diffuse;
    r.u.diffuse = {{0.9f, 0.5f, 0.1f}, use_cosine};
    return r;
}
BsdfRecord microfacet_record(float alpha, float kd) {
    BsdfRecord r{};
    r.kind = BSDF_microfacet;
    r.u.microfacet = {alpha, 1.5046f, 1.000277f, 1 - kd, {kd, kd / 2, kd / 4}};
    return r;
}
BsdfRecord phong_record(float pd, float n) {
    BsdfRecord r{};
    r.kind = BSDF_phong;
    r.u.phong = {{0.5f, 0.4f, 0.3f}, pd, {0.5f, 0.4f, 0.9f}, n};
    return r;
}
BsdfRecord discrete_record(uint kind) {
    BsdfRecord r{};
    r.kind = kind;
    r.u.dielectric = {1.5046f, 1.000277f};
    return r;
}

const std::vector<BsdfRecord> continuous = {diffuse_record(false),         diffuse_record(true),
                                            microfacet_record(0.1f, 0.3f), microfacet_record(0.5f, 0),
                                            phong_record(0.5f, 20),        phong_record(0.1f, 300)};

Vec3 direction_at(double degrees, double azimuth = 0.3) {
    const double theta = degrees * std::numbers::pi / 180;
    return stats::spherical_direction(std::cos(theta), azimuth);
}

struct Worst {
    double p = 1, cases = 0, energy = 0, weight = 0, reciprocity = 0, invalid = 0;
};

// f cos / pdf, recomputed from the drawn direction (which rounds its half vector), against the sample's weight, on
// average; and the mean weight less 5 standard errors.
void check_samples(KernelProbe &probe, unsigned id, Vec3 wi, const SelftestOptions &options, Worst &worst) {
    NumberOptions which;
    which.seed = options.seed + 77;
    const Planes drawn = probe.bsdf_sample(id, wi, probe.numbers(20000, which));
    std::vector<Vec3> wos;
    for (size_t i = 0; i < drawn.count; i++)
        wos.push_back(drawn.vec3(BSDF_WO_X, i));
    const Planes f = probe.bsdf_eval(id, wi, wos);
    for (size_t c = 0; c < 3; c++) {
        stats::Moments weights, differences;
        for (size_t i = 0; i < drawn.count; i++) {
            const double weight = drawn.at(BSDF_WEIGHT_R + c, i), pdf = drawn.at(BSDF_PDF, i);
            weights.add(weight);
            if (weight > 0)
                differences.add(std::abs(f.at(EVAL_R + c, i) * wos[i].z / (pdf * weight) - 1));
        }
        worst.weight = worst_of(worst.weight, differences.mean());
        worst.energy = worst_of(worst.energy, weights.mean() - 5 * std::sqrt(weights.variance_of_mean()));
    }
}

void check_reciprocity(KernelProbe &probe, unsigned id, Vec3 wi, Worst &worst) {
    std::vector<Vec3> wos;
    for (double degrees : {0.0, 20.0, 50.0, 75.0})
        for (double azimuth : {0.3, 2.0, 3.3})
            wos.push_back(direction_at(degrees, azimuth));
    const Planes there = probe.bsdf_eval(id, wi, wos);
    for (size_t i = 0; i < wos.size(); i++) {
        const Planes back = probe.bsdf_eval(id, wos[i], std::span(&wi, 1));
        for (size_t c = 0; c < 3; c++) {
            const double a = there.at(EVAL_R + c, i), b = back.at(EVAL_R + c, 0);
            worst.reciprocity = worst_of(worst.reciprocity, std::abs(a - b) / std::max({a, b, 1e-30}));
        }
    }
}

double invalid_at_corners(KernelProbe &probe, unsigned id, Vec3 wi) {
    const Planes drawn = probe.bsdf_sample(id, wi, corner_numbers());
    double invalid = 0;
    for (size_t i = 0; i < drawn.count; i++)
        for (size_t plane = 0; plane < BSDF_PLANES; plane++)
            invalid += !std::isfinite(drawn.at(plane, i));
    return invalid;
}

// Fresnel's reflectance in double (Born and Wolf, section 1.5.2); near and far index, cosine on the near side.
double fresnel(double cosine, double near, double far) {
    const double sine = near / far * std::sqrt(1 - cosine * cosine);
    if (sine >= 1)
        return 1;
    const double other = std::sqrt(1 - sine * sine);
    const double s = (near * cosine - far * other) / (near * cosine + far * other),
                 p = (far * cosine - near * other) / (far * cosine + near * other);
    return (s * s + p * p) / 2;
}

// A dielectric (id) from both sides: how often it reflects, where it refracts to, and what it weighs; then a mirror (id
// + 1).
Findings check_discrete(KernelProbe &probe, unsigned id, const SelftestOptions &options) {
    NumberOptions which;
    which.seed = options.seed + 99;
    const Planes numbers = probe.numbers(20000, which);
    double error = 0, smallest_p = 1, cases = 0;
    for (double degrees : {1.0, 40.0, 60.0, 80.0, 100.0, 120.0, 150.0, 179.0}) {
        const Vec3 wi = direction_at(degrees);
        const double near = wi.z > 0 ? 1.000277 : 1.5046, far = wi.z > 0 ? 1.5046 : 1.000277, eta = far / near;
        const Planes drawn = probe.bsdf_sample(id, wi, numbers);
        double reflected = 0;
        for (size_t i = 0; i < drawn.count; i++) {
            const Vec3 wo = drawn.vec3(BSDF_WO_X, i);
            const bool reflects = wo.z * wi.z > 0;
            reflected += reflects;
            const Vec3 want =
                reflects ? Vec3{-wi.x, -wi.y, wi.z}
                         : Vec3{-wi.x / eta, -wi.y / eta,
                                -std::copysign(std::sqrt(1 - (wi.x * wi.x + wi.y * wi.y) / (eta * eta)), wi.z)};
            error = worst_of(error, std::max(length(wo - want),
                                             std::abs(drawn.at(BSDF_WEIGHT_R, i) - (reflects ? 1 : 1 / (eta * eta)))));
        }
        const double mirrored =
            length(probe.bsdf_sample(id + 1, wi, Planes(2 * OPAL_PROBE_PAIRS, 1)).vec3(BSDF_WO_X, 0) -
                   Vec3{-wi.x, -wi.y, wi.z});
        error = worst_of(error, mirrored);
        const double reflectance = fresnel(std::abs(wi.z), near, far);
        if (reflectance < 1) { // at total reflection rounding may leave a little to refraction
            smallest_p =
                std::min(smallest_p, stats::binomial_test(reflected, double(drawn.count), reflectance).p_value);
            cases++;
        }
    }
    return {at_most("mirror, dielectric: direction and weight, off by", error, 3e-5),
            at_least("dielectric: reflectance, smallest p", stats::sidak_p(smallest_p, cases), selftest_level)};
}

} // namespace

Findings check_bsdfs(const Device &device, const SelftestOptions &options) {
    std::vector<BsdfRecord> records = continuous;
    records.insert(records.end(), {discrete_record(BSDF_dielectric), discrete_record(BSDF_mirror)});
    KernelProbe probe(device, scene_of_bsdfs(records), options.build, *options.sources);
    const std::vector<double> angles =
        options.full ? std::vector<double>{0, 15, 30, 45, 60, 75, 85, 89.9} : std::vector<double>{0, 50, 89.9};
    Worst worst;
    unsigned seed = options.seed;
    for (unsigned id = 0; id < records.size(); id++)
        for (double angle : angles) {
            const Vec3 wi = direction_at(angle);
            worst.invalid += invalid_at_corners(probe, id, wi);
            if (id >= continuous.size())
                continue;
            const DensityCheck check = check_density(probe, sampled_bsdf(probe, id, wi), selftest_cells(options),
                                                     selftest_cells(options), selftest_samples(options), ++seed);
            worst.p = std::min(worst.p, check.test.result.p_value);
            worst.cases++;
            check_samples(probe, id, wi, options, worst);
            check_reciprocity(probe, id, wi, worst);
        }
    Findings findings = {
        at_least("BSDFs: samples against density, smallest p", stats::sidak_p(worst.p, worst.cases), selftest_level),
        at_most("BSDFs: albedo less 5 standard errors", worst.energy, 1),
        at_most("BSDFs: weight against f cos / pdf, off by", worst.weight, 1e-4),
        at_most("BSDFs: f(a, b) against f(b, a), off by", worst.reciprocity, 1e-4),
        at_most("BSDFs: not finite at corners", worst.invalid, 0)};
    const Findings discrete = check_discrete(probe, unsigned(continuous.size()), options);
    findings.insert(findings.end(), discrete.begin(), discrete.end());
    return findings;
}

} // namespace opal
