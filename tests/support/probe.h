// The kernels' functions one by one (host/probe/kernel_probe.h), on the device that tests run on.
#pragma once

#include "probe/kernel_probe.h"
#include "support/device.h"

#include <cmath>
#include <numbers>

namespace opal::test {

inline KernelProbe probe_of(const FlatScene &scene, int lanes, const Sources &sources) {
    BuildOptions build;
    build.lanes = lanes;
    return KernelProbe(device(), scene, build, sources);
}

// A probe of these BSDFs, in double precision where the device has it.
inline KernelProbe double_probe(const std::vector<Bsdf> &bsdfs) {
    BuildOptions build;
    build.math = device().info.fp64 ? MathMode::double_precision : MathMode::precise;
    build.lanes = lanes_for(device().info, 0, build.math);
    return KernelProbe(device(), scene_of_bsdfs(bsdfs), build);
}

// Numbers for samples of a BSDF, over which a mean is a quadrature: the middles of side x side cells of the unit
// square, and lobes in an order that the odd number `step` shuffles.
inline Planes grid_of_numbers(size_t side, size_t step) {
    Planes numbers(2 * OPAL_PROBE_PAIRS, side * side);
    for (size_t i = 0; i < numbers.count; i++) {
        numbers.at(0, i) = float((double(i / side) + 0.5) / double(side));
        numbers.at(1, i) = float((double(i % side) + 0.5) / double(side));
        numbers.at(2, i) = float((double(i * step % (side * side)) + 0.5) / double(side * side));
    }
    return numbers;
}

// The mean weight of a BSDF's samples, of the first channel.
inline double albedo_of(KernelProbe &probe, unsigned id, double degrees, const Planes &numbers) {
    const double theta = degrees * std::numbers::pi / 180;
    const Planes drawn =
        probe.bsdf_sample(id, {std::sin(theta) * 0.6, std::sin(theta) * 0.8, std::cos(theta)}, numbers);
    double sum = 0;
    for (size_t i = 0; i < drawn.count; i++)
        sum += drawn.at(BSDF_WEIGHT_R, i);
    return sum / double(drawn.count);
}

inline std::string at_width(int lanes) { return " at " + std::to_string(lanes) + " lanes"; }

} // namespace opal::test
