#include "extremes/scenes.h"

#include <cmath>

namespace opal::extremes {

namespace {

// An arbitrary rotation, so that no coordinate is exact by chance.
const Transform rotation = Transform::rotate({1, 2, 3}, 34) * Transform::rotate({0, 1, 0}, 21);

template <class Value> Value moved(const Value &value, ParameterType, const Transform &) { return value; }
Vec3 moved(Vec3 value, ParameterType type, const Transform &by) {
    return type == ParameterType::POINT ? by.point(value) : by.vector(value);
}
Transform moved(const Transform &value, ParameterType, const Transform &by) { return by * value; }

} // namespace

SceneDescription moved(SceneDescription scene, const Transform &by) {
    for (Mesh &mesh : scene.meshes)
        std::visit([&](auto &shape) { shape = shape.moved(by); }, mesh.shape);
    for (Light &light : scene.lights)
        light.visit([&](const Parameter &parameter, auto &value) { value = moved(value, parameter.type, by); });
    scene.camera.to_world = by * scene.camera.to_world;
    return scene;
}

TriangleMesh slivered_cube(double aspect) {
    const double ticks[] = {-1, -1 + 1 / aspect, 1};
    TriangleMesh mesh;
    for (int i = 0; i < 27; i++)
        mesh.positions.push_back({ticks[i % 3], ticks[i / 3 % 3], ticks[i / 9]});
    const unsigned step[] = {1, 3, 9};
    for (unsigned axis = 0; axis < 3; axis++)
        for (unsigned side : {0u, 2u}) {
            const unsigned u = step[(axis + 1) % 3], v = step[(axis + 2) % 3];
            for (unsigned cell : {0u, u, v, u + v}) {
                const unsigned a = side * step[axis] + cell, b = a + (side ? v : u), c = a + (side ? u : v),
                               d = a + u + v; // inwards
                for (const auto &[x, y, z] : {std::array{a, b, d}, std::array{a, d, c}})
                    mesh.triangles.push_back({{{x, OPAL_NONE}, {y, OPAL_NONE}, {z, OPAL_NONE}}});
            }
        }
    return mesh;
}

TriangleMesh cube_with_specks(double area) {
    const TriangleMesh whole = cube({}, 1, true);
    TriangleMesh cut;
    cut.positions = whole.positions;
    for (const auto &t : whole.triangles) {
        const unsigned inner = unsigned(cut.positions.size());
        Vec3 middle{};
        for (const auto &corner : t)
            middle = middle + whole.positions[corner.position] * (1 / 3.0);
        for (const auto &corner : t)
            cut.positions.push_back(middle + (whole.positions[corner.position] - middle) * std::sqrt(area));
        cut.triangles.push_back({{{inner, OPAL_NONE}, {inner + 1, OPAL_NONE}, {inner + 2, OPAL_NONE}}});
        for (unsigned c = 0; c < 3 && area < 1; c++) { // a trapezoid along each side
            const unsigned next = (c + 1) % 3, a = t[c].position, b = t[next].position;
            cut.triangles.push_back({{{a, OPAL_NONE}, {b, OPAL_NONE}, {inner + next, OPAL_NONE}}});
            cut.triangles.push_back({{{a, OPAL_NONE}, {inner + next, OPAL_NONE}, {inner + c, OPAL_NONE}}});
        }
    }
    return cut;
}

SceneDescription path_traced(std::vector<Mesh> meshes, const Camera &camera, unsigned max_depth) {
    SceneDescription scene;
    scene.meshes = std::move(meshes);
    scene.camera = camera;
    scene.strategy[AXIS_integrator] = CHOICE_integrator_path;
    scene.strategy[AXIS_lighting] = CHOICE_lighting_mis;
    scene.strategy[AXIS_rr] = CHOICE_rr_throughput_eta;
    scene.strategy.max_depth = max_depth;
    return scene;
}

SceneDescription room() {
    return moved(path_traced({made_of(cube({}, 1, true), diffuse(0.6)),
                              made_of(quad({-0.7, -0.98, -0.3}, {0, 0, 1.1}, {1.4, 0, 0}), microfacet(0.15)),
                              made_of(quad({-0.8, -0.5, 0.97}, {0, 0.9, 0}, {0.8, 0, 0}), phong(30)),
                              made_of(cube({0.4, -0.6, 0.4}, 0.3, false), diffuse(0.7)),
                              made_of(cube({-0.4, -0.3, 0.2}, 0.2, false), dielectric(1.5)),
                              light(Parallelogram{{-0.4, 0.97, -0.4}, {0.8, 0, 0}, {0, 0, 0.8}}, 6)},
                             camera({0.1, 0.05, -0.97}, {0, -0.2, 1}, 85), 8),
                 rotation);
}

SceneDescription occlusion_of(SceneDescription scene) {
    scene.strategy[AXIS_integrator] = CHOICE_integrator_ao;
    scene.strategy[AXIS_hemisphere] = CHOICE_hemisphere_cosine;
    return scene;
}

SceneDescription closed_walls() { return occlusion_of(room()); }

SceneDescription open_plane() {
    return occlusion_of(moved(path_traced({made_of(quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), diffuse(0.5))},
                                          camera({0.1, 0.6, -0.5}, {0.05, 0, 0.1}, 30), 1),
                              rotation));
}

SceneDescription balls() {
    return moved(
        path_traced({made_of(Sphere{{}, 1, true}, diffuse(0.6)), made_of(Sphere{{0.35, -0.45, 0.3}, 0.3}, diffuse(0.7)),
                     made_of(Sphere{{-0.3, -0.3, 0.2}, 0.25}, dielectric(1.5)),
                     made_of(Sphere{{-0.5, 0.2, 0.5}, 0.25}, microfacet(0.15)),
                     light(Sphere{{0.2, 0.6, 0.3}, 0.15}, 20)},
                    camera({0.1, 0.05, -0.9}, {0, -0.1, 1}, 75), 8),
        rotation);
}

SceneDescription round_walls() { return occlusion_of(balls()); }

SceneDescription open_ball() {
    return occlusion_of(
        moved(path_traced({made_of(Sphere{{}, 1}, diffuse(0.5))}, camera({0.4, 1.1, -0.9}, {0.05, 0, 0.1}, 30), 1),
              rotation));
}

SceneDescription moved(SceneDescription scene, double factor, Vec3 offset) {
    return moved(std::move(scene), Transform::translate(offset) * Transform::scale({factor, factor, factor}));
}

} // namespace opal::extremes
