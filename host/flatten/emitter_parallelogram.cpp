#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

namespace opal {

// The parallelogram is known by its first triangle, whose corners are o, o + u and o + v.
double flatten_parallelogram(const EmittingMesh &from, EmitterRecord &record, FlatScene &) {
    emitter_parallelogram_record &own = record.u.of_parallelogram;
    const auto &[o, u, v] = from.soup.corners[from.begin];
    const auto &vertices = from.soup.vertices;
    for (int axis = 0; axis < 3; axis++) {
        own.origin[axis] = vertices[o][axis];
        own.u[axis] = vertices[u][axis] - vertices[o][axis];
        own.v[axis] = vertices[v][axis] - vertices[o][axis];
    }
    const Vec3 normal = normal_of(vertices[o], vertices[u], vertices[v]);
    const double area = length(normal);
    store(normal * (1 / area), own.normal);
    store(*from.mesh.radiance, 1, own.color);
    own.area = float(area);
    own.uv_exchanged = std::get<Parallelogram>(from.mesh.shape).uv_exchanged;
    return area;
}

} // namespace opal
