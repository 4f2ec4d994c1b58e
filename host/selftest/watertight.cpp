#include "selftest/watertight.h"

#include <cmath>
#include <numbers>

namespace opal::edges {

SceneDescription scene_of(const std::vector<Vec3> &positions, const std::vector<std::array<unsigned, 3>> &triangles) {
    TriangleMesh shape;
    shape.positions = positions;
    for (const auto &[a, b, c] : triangles)
        shape.triangles.push_back({{{a, OPAL_NONE}, {b, OPAL_NONE}, {c, OPAL_NONE}}});
    SceneDescription scene;
    scene.meshes.resize(1);
    scene.meshes[0].shape = shape;
    return scene;
}

SceneDescription closed_sphere(unsigned rows) {
    std::vector<Vec3> positions;
    std::vector<std::array<unsigned, 3>> triangles;
    const unsigned columns = 2 * rows;
    for (unsigned row = 0; row <= rows; row++)
        for (unsigned column = 0; column < columns; column++)
            positions.push_back(
                stats::spherical_direction(std::cos(std::numbers::pi * row / rows), std::numbers::pi * column / rows));
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
    return scene_of(positions, triangles);
}

std::vector<Corners> corners_of(const FlatScene &scene, std::vector<uint> &slots) {
    std::vector<Corners> all;
    for (uint slot = 0; slot < 8 * scene.blocks.size(); slot++)
        if (const TriangleBlock &block = scene.blocks[slot / 8]; block.id[slot % 8] != OPAL_NONE) {
            Corners corners;
            for (int c = 0; c < 3; c++)
                corners[size_t(c)] = {block.vertex[c][0][slot % 8], block.vertex[c][1][slot % 8],
                                      block.vertex[c][2][slot % 8]};
            all.push_back(corners);
            slots.push_back(slot);
        }
    return all;
}

void set_ray(Planes &rays, size_t i, Vec3 o, Vec3 d, double tmax) {
    const double values[RAY_PLANES] = {o.x, o.y, o.z, d.x, d.y, d.z, 0, tmax};
    for (size_t plane = 0; plane < RAY_PLANES; plane++)
        rays.at(plane, i) = float(values[plane]);
}

unsigned long long lost_rays(KernelProbe &probe, size_t count, std::mt19937 &random) {
    std::vector<uint> slots;
    const std::vector<Corners> triangles = corners_of(probe.scene(), slots);
    const auto unit = [&random] { return double(random()) * 0x1p-32; };
    const auto on_edge = [&](size_t kind) { // a vertex, the middle of an edge, or any point of it
        const Corners &p = triangles[random() % triangles.size()];
        const size_t corner = random() % 3;
        const double s = kind == 0 ? 0 : kind == 1 ? 0.5 : unit();
        return p[corner] + (p[(corner + 1) % 3] - p[corner]) * s;
    };
    Planes rays(RAY_PLANES, count);
    for (size_t i = 0; i < count; i++) {
        const Vec3 inside = on_edge(2) * (0.9 * unit()), o = {float(inside.x), float(inside.y), float(inside.z)};
        set_ray(rays, i, o, on_edge(i % 4) - o, 1e30);
    }
    const Planes hits = probe.trace(rays);
    unsigned long long lost = 0;
    for (size_t i = 0; i < count; i++)
        lost += hits.bits(HIT_SLOT, i) == OPAL_NONE || hits.at(HIT_ANY, i) == 0;
    return lost;
}

} // namespace opal::edges
