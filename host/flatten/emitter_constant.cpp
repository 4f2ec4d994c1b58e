#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

#include <numbers>

namespace opal {

void add_extent(const emitter_constant &, Extent &) {}

// pi L through each point of the bounding sphere, whose surface is 4 pi radius^2.
double power_of(const emitter_constant &light, double radius) {
    constexpr double pi = std::numbers::pi;
    return pi * luminance(light.radiance) * 4 * pi * radius * radius;
}

emitter_constant_record flattened(const emitter_constant &light, const Flattening &) {
    emitter_constant_record record{};
    store(light.radiance, 1, record.color);
    return record;
}

} // namespace opal
