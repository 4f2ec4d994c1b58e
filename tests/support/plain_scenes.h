// Scenes written in C++, and questions to a flattened one.
#pragma once

#include "flatten/flat_scene.h"
#include "scene/examples.h"

#include <stdexcept>

namespace opal {

using examples::cube;
using examples::diffuse;
using examples::made_of;
using examples::mesh_of;
using examples::quad;

// A mesh of the material diffuse(albedo, use_cosine).
inline Mesh diffuse(Shape shape, double albedo = 0.5, bool use_cosine = false) {
    return made_of(std::move(shape), diffuse(albedo, use_cosine));
}

inline Mesh light(Shape shape, Color radiance) {
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
    const auto &axes = scene.triangle_blocks.at(slot / 8).vertex[corner];
    return {axes[0][slot % 8], axes[1][slot % 8], axes[2][slot % 8]};
}

inline double area_of(const FlatScene &scene, uint slot) {
    const auto a = vertex(scene, slot, 0), b = vertex(scene, slot, 1), c = vertex(scene, slot, 2);
    const Vec3 p{a[0], a[1], a[2]};
    return length(cross(Vec3{b[0], b[1], b[2]} - p, Vec3{c[0], c[1], c[2]} - p)) / 2;
}

} // namespace opal
