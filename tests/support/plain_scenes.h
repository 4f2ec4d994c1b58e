// Scenes written in C++, and what tests ask of a flattened one.
#pragma once

#include "flatten/flat_scene.h"

#include <stdexcept>

namespace opal {

inline TriangleMesh mesh_of(std::vector<Vec3> positions, std::vector<std::array<unsigned, 3>> triangles) {
    TriangleMesh mesh;
    mesh.positions = std::move(positions);
    for (const auto &[a, b, c] : triangles)
        mesh.triangles.push_back({{{a, OPAL_NONE}, {b, OPAL_NONE}, {c, OPAL_NONE}}});
    return mesh;
}

inline Mesh diffuse(std::variant<TriangleMesh, Parallelogram> shape, float albedo = 0.5f, bool use_cosine = false) {
    Mesh mesh;
    mesh.shape = std::move(shape);
    mesh.bsdf.record.kind = BSDF_diffuse;
    mesh.bsdf.record.u.diffuse = {{albedo, albedo, albedo}, use_cosine};
    return mesh;
}

inline Mesh light(std::variant<TriangleMesh, Parallelogram> shape, Color radiance) {
    Mesh mesh = diffuse(std::move(shape));
    mesh.radiance = radiance;
    return mesh;
}

inline const TriangleMesh one_triangle = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});

inline SceneDescription scene_of(std::vector<Mesh> meshes) {
    SceneDescription scene;
    scene.meshes = std::move(meshes);
    scene.strategy[AXIS_integrator] = CHOICE_integrator_path;
    scene.strategy[AXIS_lighting] = CHOICE_lighting_mis;
    return scene;
}

// Corner of the triangle in that slot.
inline std::array<float, 3> vertex(const FlatScene &scene, uint slot, int corner) {
    const auto &axes = scene.blocks.at(slot / 8).vertex[corner];
    return {axes[0][slot % 8], axes[1][slot % 8], axes[2][slot % 8]};
}

inline double area_of(const FlatScene &scene, uint slot) {
    const auto a = vertex(scene, slot, 0), b = vertex(scene, slot, 1), c = vertex(scene, slot, 2);
    const Vec3 p{a[0], a[1], a[2]};
    return length(cross(Vec3{b[0], b[1], b[2]} - p, Vec3{c[0], c[1], c[2]} - p)) / 2;
}

} // namespace opal
