// Every warp: samples against the density, its integral, and the corners of the unit square.
#include "densities/sampled.h"
#include "selftest/selftest.h"

#include <cmath>

namespace opal {

namespace {

struct WarpCase {
    int warp;
    float parameter;
};

std::vector<WarpCase> warp_cases() {
    return {{WARP_tent, 0},
            {WARP_uniform_disk, 0},
            {WARP_uniform_sphere, 0},
            {WARP_uniform_hemisphere, 0},
            {WARP_cosine_hemisphere, 0},
            {WARP_beckmann, 0.05f},
            {WARP_beckmann, 0.3f},
            {WARP_beckmann, 1},
            {WARP_phong_lobe, 0},
            {WARP_phong_lobe, 20},
            {WARP_phong_lobe, 1000}};
}

// Of what the corners of the unit square are mapped to.
double invalid_at_corners(KernelProbe &probe, const WarpCase &c) {
    const Planes corners = corner_numbers();
    const Planes drawn = probe.warp_sample(c.warp, c.parameter, corners);
    std::vector<Vec3> points;
    double invalid = 0;
    for (size_t i = 0; i < drawn.count; i++) {
        const Vec3 p = drawn.vec3(WARP_X, i);
        invalid += !(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        points.push_back(p);
    }
    const Planes pdf = probe.warp_pdf(c.warp, c.parameter, points);
    for (size_t i = 0; i < pdf.count; i++)
        invalid += !(std::isfinite(pdf.at(0, i)) && pdf.at(0, i) >= 0);
    return invalid;
}

} // namespace

Findings check_warps(const Device &device, const SelftestOptions &options) {
    KernelProbe probe(device, scene_of_bsdfs({}), options.build, *options.sources);
    double smallest_p = 1, mass_error = 0, invalid = 0;
    unsigned seed = options.seed;
    const std::vector<WarpCase> cases = warp_cases();
    for (const WarpCase &c : cases) {
        const DensityCheck check =
            check_density(probe, sampled_warp(probe, c.warp, c.parameter), selftest_cells(options),
                          selftest_cells(options), selftest_samples(options), ++seed);
        smallest_p = std::min(smallest_p, check.test.result.p_value);
        mass_error = worst_of(mass_error, std::abs(check.test.mass.value - 1));
        invalid += invalid_at_corners(probe, c);
    }
    return {at_least("warps: samples against density, smallest p", stats::sidak_p(smallest_p, double(cases.size())),
                     selftest_level),
            at_most("warps: integral of the pdf, off by", mass_error, 1e-4),
            at_most("warps: not finite at corners", invalid, 0)};
}

} // namespace opal
