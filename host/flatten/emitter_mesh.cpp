#include "flatten/emitter_kinds.h"

#include "flatten/distribution.h"
#include "flatten/store.h"

namespace opal {

double flatten_mesh(const EmittingMesh &from, EmitterRecord &record, FlatScene &scene) {
    std::vector<double> areas;
    double area = 0;
    for (uint id = from.begin; id < from.end; id++) {
        areas.push_back(triangle_area(from.soup, id));
        area += areas.back();
    }
    store(*from.mesh.radiance, 1, record.u.of_mesh.color);
    record.u.of_mesh.first_triangle = from.begin;
    record.first = uint(scene.light_triangles.size());
    record.count = from.end - from.begin;
    const AliasTable table = build_alias_table(from.uniform_triangles ? std::vector<double>(areas.size(), 1.0) : areas);
    for (uint i = 0; i < record.count; i++)
        scene.light_triangles.push_back({from.slots[from.begin + i], float(table.accept[i]), table.other[i],
                                         float(areas[i] / table.probability[i])});
    return area;
}

} // namespace opal
