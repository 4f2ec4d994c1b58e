// Stress tests without a picture: single functions of the kernels, called in single and in double precision.
#pragma once

#include "device/program.h"

#include <optional>

namespace opal::extremes {

// The size of a stress test.
struct StressSettings {
    unsigned side = 64, spp = 256, seed = 1; // the picture: pixels along each side, samples of each pixel
    const Sources *sources = &Sources::embedded();
    // Samples of the picture; a numeric row uses as many numbers or rays.
    unsigned long long paths() const { return (unsigned long long)(side)*side * spp; }
};

// The measurement of a numeric row at one value.
struct NumericResult {
    double single, oracle;                             // the row's figure in single and in double precision
    double error;                                      // largest difference of any returned value
    unsigned long long invalid_single, invalid_oracle; // counts of values that are NaN, infinite or out of range
    std::optional<double> leaks = {};                  // share of rays that pass a closed mesh
};

// Samples every warp, BSDF and light with pairs of `u` and other random numbers. Figure: the mean third component of
// the sampled points, directions and weights.
NumericResult measure_numbers(double u, const Device &device, const StressSettings &settings);

// Draws the numbers of every sampler for samples from the first to the last of `spp`. Figure: their mean. Invalid
// numbers are outside [0, 1).
NumericResult measure_samplers(double spp, const Device &device, const StressSettings &settings);

// Reflectance of glass from inside near the critical angle; the sine of the angle is `ulps` floats beyond that of total
// reflection. Figure: the share of reflected samples.
NumericResult measure_critical_angle(double ulps, const Device &device, const StressSettings &settings);

// Shoots rays at the edges and vertices of closed meshes of size `scale`, which are rotated and moved at random.
// Figure: the share of rays that miss.
NumericResult measure_edges(double scale, const Device &device, const StressSettings &settings);

// The same in one precision, for long runs: the number of misses of at least `rays` rays.
unsigned long long lost_at_edges(double scale, unsigned long long rays, const Device &device,
                                 const StressSettings &settings, MathMode math);

} // namespace opal::extremes
