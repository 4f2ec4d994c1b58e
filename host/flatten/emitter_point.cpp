#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

#include <numbers>

namespace opal {

void add_extent(const emitter_point &light, Extent &extent) { extent.add(light.position); }

double power_of(const emitter_point &light, double) { return luminance(light.power); }

emitter_point_record flattened(const emitter_point &light, const Flattening &flattening) {
    emitter_point_record record{};
    store((light.position - flattening.center) * flattening.scale, record.position);
    store(light.power, flattening.scale * flattening.scale / (4 * std::numbers::pi), record.color);
    return record;
}

} // namespace opal
