#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

namespace opal {

void add_extent(const emitter_spot &light, Extent &extent) { extent.add(light.position); }

double power_of(const emitter_spot &light, double) { return luminance(light.intensity); }

emitter_spot_record flattened(const emitter_spot &light, const Flattening &flattening) {
    emitter_spot_record record{};
    store((light.position - flattening.center) * flattening.scale, record.position);
    return record;
}

} // namespace opal
