// Sampling on the device beside the density that the device states: of a warp, of a BSDF seen from one direction, of
// the lights of a scene.
#pragma once

#include "probe/kernel_probe.h"

#include <functional>
#include <string>

namespace opal {

struct Sampled {
    std::string name;
    const stats::Domain *domain = nullptr;
    // Adds a sample to the histogram for each column of random numbers.
    std::function<void(const Planes &numbers, stats::Histogram &histogram)> draw;
    stats::Density density;                 // the device's, over the domain's measure
    bool may_fail = false;                  // a draw may give no sample (host/stats/histogram.h)
    std::vector<double> splits_u, splits_v; // where the density has peaks and edges, for quadrature
    double relative_error = 1e-5;           // of quadrature, in a cell
};

const char *warp_name(int warp);
Sampled sampled_warp(KernelProbe &probe, int warp, float parameter);

// The BSDF of mesh `id` of the probe's scene, over the whole sphere. A draw has failed if its weight and density are 0,
// or if it went in a single direction, which is no part of the density. Error: a discrete BSDF, which has no density.
Sampled sampled_bsdf(KernelProbe &probe, unsigned id, Vec3 wi);
bool is_discrete(const Bsdf &bsdf); // and nothing else

// The lights of the probe's scene as they are seen from a point, in the scene's own units: points on lights in the unit
// square of the plane z = 0, directions to an environment that is alone, or directions to a sphere that is alone, which
// fill the unit square. Delta lights have no density.
Sampled sampled_lights(KernelProbe &probe, Vec3 from = {0.2, 0.7, 0.6});

// Rays from a point, in flattened units, that end nowhere.
Planes rays_from(Vec3 from, std::span<const Vec3> directions);

struct DensityCheck {
    stats::Histogram histogram;
    stats::DensityTest test;
};
// Chi-square of `count` samples on a grid of nu x nv cells.
DensityCheck check_density(KernelProbe &probe, const Sampled &sampled, int nu, int nv, size_t count, unsigned seed,
                           const stats::ChiSquareOptions &options = {});

// Passes random numbers for `count` samples to `use`, in batches that fit in memory.
void draw_in_batches(KernelProbe &probe, size_t count, unsigned seed,
                     const std::function<void(const Planes &numbers)> &use);

} // namespace opal
