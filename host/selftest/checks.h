// The checks of `opal selftest`, with what they compare and how hard they look as arguments: a finding for each case.
// Tests and the negative controls of the kernels call them too.
#pragma once

#include "densities/sampled.h"
#include "selftest/selftest.h"

namespace opal {

// How hard a check looks.
struct Effort {
    size_t samples = 60'000;                    // in a histogram
    int nu = 16, nv = 16;                       // cells of its grid
    size_t draws = 20'000;                      // samples of a BSDF that are compared one by one
    std::vector<double> angles = {0, 50, 89.9}; // of incidence, degrees
    double quadrature_error = 1e-2;             // relative, of a light's density in a cell
    unsigned seed = 0;
    double density_error = 0; // of a delta light's density, which is 1
    bool each_sample = false; // besides the mean over all samples, judge the weight and the density of each
};

Effort effort_of(const SelftestOptions &options);

struct WarpCase {
    int warp; // WARP_*
    float parameter;
};
const std::vector<WarpCase> &selftest_warps();

// Samples against the density, the density's integral, and what becomes of numbers at the unit square's corners.
Findings warp_findings(KernelProbe &probe, const std::vector<WarpCase> &cases, const Effort &effort);

struct Material {
    std::string name;
    Bsdf bsdf;
};
// Every kind of BSDF, written as a scene writes it. They are part of the binary, which runs where there are no test
// cases.
const std::vector<Material> &selftest_materials();
// A scene of these BSDFs in this order, and nothing else.
FlatScene scene_of_materials(const std::vector<Material> &materials);

// Samples against the density; albedo at most 1; weights against f cos / pdf; reciprocity; random numbers at the
// corners. Discrete ones have no density: directions and weights against the laws of reflection and refraction,
// reflectance against Fresnel's formulas. `probe` has the scene_of_materials.
Findings material_findings(KernelProbe &probe, const std::vector<Material> &materials, const Effort &effort);

// Reflectance for unpolarised light in double (Born and Wolf, "Principles of Optics", section 1.5.2): cosine of the
// incident ray, indices of refraction on its side and beyond.
double fresnel_reflectance(double cosine, double near, double far);

// Directions to lights against the density that a hit on them is weighed with, and the density's integral.
Findings light_findings(KernelProbe &probe, const Sampled &lights, const std::string &subject, const Effort &effort);

// An emitter of scenes, alone in the probe's scene: an environment's directions as above; of delta lights, that their
// samples lie in one direction and fall off as they should; the power by which it is chosen.
Findings scene_emitter_findings(KernelProbe &probe, const Light &light, const std::string &subject,
                                const Effort &effort);
FlatScene scene_of_light(const Light &light, int lanes);

} // namespace opal
