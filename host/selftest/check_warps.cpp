// Every warp: samples against the density, its integral, and the corners of the unit square.
#include "selftest/checks.h"

#include <fmt/format.h>

#include <cmath>

namespace opal {

namespace {

// How many results are no numbers, or densities below 0, for numbers at the corners of the unit square.
double invalid_at_corners(KernelProbe &probe, const WarpCase &c) {
    const Planes drawn = probe.warp_sample(c.warp, c.parameter, corner_numbers());
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

const std::vector<WarpCase> &selftest_warps() {
    static const std::vector<WarpCase> cases = {
        {WARP_tent, 0},           {WARP_uniform_disk, 0},       {WARP_concentric_disk, 0},
        {WARP_uniform_sphere, 0}, {WARP_uniform_hemisphere, 0}, {WARP_cosine_hemisphere, 0},
        {WARP_beckmann, 0.05f},   {WARP_beckmann, 0.3f},        {WARP_beckmann, 1},
        {WARP_phong_lobe, 0},     {WARP_phong_lobe, 20},        {WARP_phong_lobe, 1000}};
    return cases;
}

Findings warp_findings(KernelProbe &probe, const std::vector<WarpCase> &cases, const Effort &effort) {
    Findings findings;
    unsigned seed = effort.seed;
    for (const WarpCase &c : cases) {
        const DensityCheck check = check_density(probe, sampled_warp(probe, c.warp, c.parameter), effort.nu, effort.nv,
                                                 effort.samples, ++seed);
        const std::string subject = fmt::format("{} {:g}", warp_name(c.warp), c.parameter);
        findings.push_back(p_value("warps: samples against density, smallest p", check.test.result.p_value, subject));
        findings.push_back(
            at_most("warps: integral of the pdf, off by", std::abs(check.test.mass.value - 1), 1e-4, subject));
        findings.push_back(none_wrong("warps: not finite at corners", invalid_at_corners(probe, c), subject));
    }
    return findings;
}

Findings run_warps(const Device &device, const SelftestOptions &options) {
    KernelProbe probe(device, scene_of_bsdfs({}), options.build, *options.sources);
    return summary_of(warp_findings(probe, selftest_warps(), effort_of(options)));
}

} // namespace opal
