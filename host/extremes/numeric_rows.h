// Sweeps that need no picture: functions of the kernels asked one by one, in single and in double precision.
#pragma once

#include "device/context.h"
#include "device/sources.h"

#include <optional>

namespace opal::extremes {

struct How {
    unsigned side = 64, spp = 256,
             seed = 1; // pixels a side; a probe takes as many numbers or rays as the picture would have samples
    const Sources *sources = &Sources::embedded();
    unsigned long long paths() const { return (unsigned long long)(side)*side * spp; }
};

struct Probed {
    double single, oracle; // a figure in both precisions
    double error;          // the largest difference of anything they return
    unsigned long long invalid_single, invalid_oracle;
    std::optional<double> leaks = {};
};

// Every warp, BSDF and light at `u` and all pairs of it with other numbers. The figure: the mean height of what is
// drawn.
Probed probe_numbers(double u, const Device &device, const How &how);

// Every sampler's last numbers of `spp` samples. The figure: their mean. Invalid: outside [0, 1).
Probed probe_samplers(double spp, const Device &device, const How &how);

// Reflectance of glass from inside, sin^2 of the angle being `ulps` beyond that of total reflection, by which share of
// samples is reflected.
Probed probe_critical_angle(double ulps, const Device &device, const How &how);

// Rays at the edges and vertices of closed meshes of size `scale`, each turned and moved anyhow. The figure: the share
// that is lost.
Probed probe_edges(double scale, const Device &device, const How &how);

// The same without the oracle, for counts that take long: how many of at least `rays` are lost.
unsigned long long lost_at_edges(double scale, unsigned long long rays, const Device &device, const How &how,
                                 MathMode math);

} // namespace opal::extremes
