#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

#include <numbers>

namespace opal {

void add_extent(const emitter_directional &, Extent &) {}

double power_of(const emitter_directional &light, double radius) {
    return luminance(light.irradiance) * std::numbers::pi * radius * radius;
}

emitter_directional_record flattened(const emitter_directional &light, const Flattening &) {
    emitter_directional_record record{};
    store(normalize(light.direction), record.direction);
    store(light.irradiance, 1, record.color);
    return record;
}

} // namespace opal
