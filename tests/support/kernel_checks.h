// Checks of the functions that rendering uses, run one by one on the device (host/probe/kernel_probe.h), at 1 lane and
// at the device's width. As in support/checks.h: a right kernel passes, its mutants must not.
#pragma once

#include "support/cases.h"
#include "support/checks.h"

namespace opal::test {

Findings check_known_numbers(const Sources &sources, unsigned seed); // bit for bit, never 1
Findings check_dimensions(const Sources &sources, unsigned);         // keys
Findings check_sobol(const Sources &sources, unsigned seed);         // elementary intervals
Findings check_stratified(const Sources &sources, unsigned seed);    // strata, permutations
Findings check_independence(const Sources &sources,
                            unsigned seed); // uniform; pixels, samples, dimensions, seeds uncorrelated

Findings check_tree(const Sources &sources, unsigned seed);       // closest and any hit against brute force in double
Findings check_tiny(const Sources &sources, unsigned seed);       // the same without a tree
Findings check_spheres(const Sources &sources, unsigned seed);    // the same of spheres; rays that leave them
Findings check_watertight(const Sources &sources, unsigned seed); // rays at edges and vertices of closed meshes

Findings check_warps(const Sources &sources, unsigned seed);         // warp_findings of selftest's warps and two more
Findings check_bsdfs(const Sources &sources, unsigned seed);         // check_materials of tests/cases/bsdfs
Findings check_nested_bsdfs(const Sources &sources, unsigned);       // blends and changed normals against Mitsuba's
Findings check_facets(const Sources &sources, unsigned seed);        // densities of normals against integrals
Findings check_principled(const Sources &sources, unsigned seed);    // and oren_nayar: f and densities, albedos
Findings check_albedos(const Sources &sources, unsigned seed);       // microfacet against quadrature
Findings check_refraction(const Sources &sources, unsigned seed);    // Snell's law and Fresnel's formulas in double
Findings check_metals(const Sources &sources, unsigned);             // smooth metals and panes against Mitsuba
Findings check_plastics(const Sources &sources, unsigned);           // against Mitsuba's f, densities and samples
Findings check_choices(const Sources &sources, unsigned seed);       // shares of BSDFs' parts, number by number
Findings check_emitters(const Sources &sources, unsigned seed);      // check_lights of tests/cases/emitters
Findings check_trigonometry(const Sources &sources, unsigned seed);  // cos_sin_2pi against double
Findings check_cameras(const Sources &sources, unsigned);            // rays against Mitsuba's, to 1e-5
Findings check_delta_lights(const Sources &sources, unsigned);       // spots and directional, to 1e-5
Findings check_sphere_lights(const Sources &sources, unsigned seed); // from near, far and inside
// Samples of lights with textures against rays, alone and together.
Findings check_textured_lights(const Sources &sources, unsigned seed);
Findings check_environments(const Sources &sources, unsigned); // radiance and density against Mitsuba's
Findings check_skies(const Sources &sources, unsigned seed);   // environments that are hard to sample

// material_findings of these materials.
Findings check_materials(const std::vector<Material> &materials, const Sources &sources, unsigned seed);
// check_bsdfs and check_emitters of some of their cases alone, which takes seconds instead of minutes. Throws where
// there is no such case.
Check check_of_bsdfs(std::vector<std::string> names);
Check check_of_emitters(std::vector<std::string> names);
// Directions to each light, and to all meshes in one scene, against their density, for all ways to choose emitters and
// triangles; samples against rays of their direction; of emitters of scenes, what selftest asks.
Findings check_lights(const std::vector<LightCase> &cases, const Sources &sources, unsigned seed);

} // namespace opal::test
