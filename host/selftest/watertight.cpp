#include "selftest/watertight.h"

#include "scene/examples.h"

#include <cmath>
#include <numbers>

namespace opal::edges {

TriangleMesh closed_sphere(unsigned rows, unsigned columns) {
    std::vector<Vec3> positions;
    std::vector<std::array<unsigned, 3>> triangles;
    if (columns == 0)
        columns = 2 * rows;
    for (unsigned row = 0; row <= rows; row++)
        for (unsigned column = 0; column < columns; column++)
            positions.push_back(stats::spherical_direction(std::cos(std::numbers::pi * row / rows),
                                                           2 * std::numbers::pi * column / columns));
    for (unsigned row = 0; row < rows; row++)
        for (unsigned column = 0; column < columns; column++) {
            const unsigned a = row * columns + column, b = row * columns + (column + 1) % columns, c = a + columns,
                           d = b + columns;
            if (row > 0)
                triangles.push_back({a, b, c});
            if (row + 1 < rows)
                triangles.push_back({b, d, c});
        }
    for (unsigned column = 0; column < columns; column++) { // one point at each pole
        positions[column] = {0, 0, 1};
        positions[rows * columns + column] = {0, 0, -1};
    }
    return examples::mesh_of(std::move(positions), triangles);
}

size_t lost_rays(KernelProbe &probe, size_t count, std::mt19937 &random) {
    const std::vector<SlotTriangle> triangles = triangles_by_slot(probe.scene());
    const auto unit = [&random] { return double(random()) * 0x1p-32; };
    const auto on_edge = [&](size_t kind) { // a vertex, the middle of an edge, or any point of it
        const std::array<Vec3, 3> &p = triangles[random() % triangles.size()].corners;
        const size_t corner = random() % 3;
        const double s = kind == 0 ? 0 : kind == 1 ? 0.5 : unit();
        return p[corner] + (p[(corner + 1) % 3] - p[corner]) * s;
    };
    std::vector<HostRay> rays;
    for (size_t i = 0; i < count; i++) {
        const Vec3 inside = on_edge(2) * (0.9 * unit()), o = {float(inside.x), float(inside.y), float(inside.z)};
        rays.push_back({o, on_edge(i % 4) - o, 0, 1e30});
    }
    return lost_among(probe, std::move(rays));
}

} // namespace opal::edges
