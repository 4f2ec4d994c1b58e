#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

#include <algorithm>
#include <numbers>

namespace opal {

double flatten_sphere(const EmittingMesh &from, EmitterRecord &record, FlatScene &) {
    emitter_sphere_record &own = record.u.of_sphere;
    const Sphere &sphere = std::get<Sphere>(from.mesh.shape);
    const Point3f center = from.flattening(sphere.center);
    std::ranges::copy(center, own.center);
    own.radius = from.flattening.distance(sphere.radius);
    own.inward = sphere.inward;
    const auto primitive = std::ranges::lower_bound(from.soup.others, from.index, {}, &BoundedPrimitive::mesh);
    own.sphere = primitive->id & OPAL_BLOCK_BITS;
    store(*from.mesh.radiance, 1, own.color);
    return 4 * std::numbers::pi * own.radius * own.radius;
}

} // namespace opal
