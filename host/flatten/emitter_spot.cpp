#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opal {

namespace {

constexpr double pi = std::numbers::pi;

// The angles from the axis up to which the intensity is full, and at which it is 0, radians.
struct Cone {
    double beam, cutoff;

    explicit Cone(const emitter_spot &light)
        : beam(std::min(light.beam_width, light.cutoff_angle) * (pi / 180)), cutoff(light.cutoff_angle * (pi / 180)) {}
    // cos beam - cos cutoff
    double drop() const { return 2 * std::sin((cutoff + beam) / 2) * std::sin((cutoff - beam) / 2); }
};

double one_minus_cos(double angle) { return 2 * std::pow(std::sin(angle / 2), 2); }

double one_minus_sinc(double x) { return x < 1e-3 ? x * x / 6 : 1 - std::sin(x) / x; }

// The integral of the falloff over all directions, sr. In proportion to the angle:
//   2 pi (1 - (sin c - sin b) / (c - b)) = 2 pi (1 - cos m sinc h), m the mean of b and c, h half their difference.
// Smooth: a share that grows evenly with the cosine, of which the fourth power is a fifth on average.
double falloff_integral(const emitter_spot &light) {
    const Cone cone(light);
    if (light.smooth)
        return 2 * pi * (one_minus_cos(cone.beam) + cone.drop() / 5);
    const double m = (cone.cutoff + cone.beam) / 2, h = (cone.cutoff - cone.beam) / 2;
    return 2 * pi * (one_minus_cos(m) + std::cos(m) * one_minus_sinc(h));
}

} // namespace

void add_extent(const emitter_spot &light, Extent &extent) { extent.add(light.position); }

double power_of(const emitter_spot &light, double) { return luminance(light.intensity) * falloff_integral(light); }

emitter_spot_record flattened(const emitter_spot &light, const Flattening &flattening) {
    constexpr double steepest = 1e30; // of a light without transition: the share is 0 or 1 at any other angle
    const Cone cone(light);
    const double transition = light.smooth ? cone.drop() / 2 : cone.cutoff - cone.beam;
    emitter_spot_record record{};
    store(light.intensity, flattening.scale * flattening.scale, record.color);
    store((light.position - flattening.center) * flattening.scale, record.position);
    store(normalize(light.direction), record.direction);
    record.cutoff_angle = float(cone.cutoff);
    record.inverse_transition = float(std::min(1 / transition, steepest));
    record.smooth = light.smooth;
    return record;
}

} // namespace opal
