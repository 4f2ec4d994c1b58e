#include "support/rooms.h"

#include <numbers>

namespace opal::test {

namespace {

constexpr Vec3 light_corners[3] = {{-0.6, 1, 0.1}, {0.7, 1.3, -0.4}, {0.2, 0.9, 0.8}};
constexpr Vec3 floor_point = {0.3, 0, 0.2};
constexpr double floor_albedo = 0.8, light_red = 3;

// The walls of [-1, 1]^3, facing inwards.
std::vector<Mesh> walls() {
    return {diffuse(Parallelogram{{-1, -1, -1}, {0, 0, 2}, {2, 0, 0}}, 0.6f),
            diffuse(Parallelogram{{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}}, 0.7f, true),
            diffuse(Parallelogram{{-1, -1, 1}, {0, 2, 0}, {2, 0, 0}}, 0.5f, true),
            diffuse(Parallelogram{{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}}, 0.5f),
            diffuse(Parallelogram{{-1, -1, -1}, {0, 2, 0}, {0, 0, 2}}, 0.4f, true),
            diffuse(Parallelogram{{1, -1, -1}, {0, 0, 2}, {0, 2, 0}}, 0.6f)};
}

// A fan of three triangles under the ceiling, facing down, one of them a sliver.
TriangleMesh fan_light() {
    const double y = 0.98;
    return mesh_of({{-0.7, y, -0.6}, {0.6, y, -0.6}, {0.6, y, 0.5}, {0.596, y, 0.503}, {-0.7, y, 0.5}},
                   {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
}

TriangleMesh octahedron(Vec3 center, double size) {
    TriangleMesh mesh;
    mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const Vec3 &n : mesh.normals)
        mesh.positions.push_back(center + n * size);
    for (unsigned x : {0u, 1u})
        for (unsigned y : {2u, 3u})
            for (unsigned z : {4u, 5u}) {
                const bool flip = (x + (y - 2) + (z - 4)) % 2 == 1;
                const unsigned second = flip ? z : y, third = flip ? y : z;
                mesh.triangles.push_back({{{x, x}, {second, second}, {third, third}}});
            }
    return mesh;
}

SceneDescription room(std::vector<Mesh> meshes, int width, int height, bool black_lights) {
    for (Mesh &wall : walls())
        meshes.push_back(std::move(wall));
    meshes.push_back(made_of(quad({-0.2, 0.8, -0.5}, {0, 0, 0.6}, {0.6, 0, 0}),
                             diffuse(0.5))); // a screen near the light
    meshes.push_back(light(fan_light(), {6, 5, 4}));
    meshes.push_back(light(Parallelogram{{-0.98, -0.2, -0.3}, {0, 0.7, 0}, {0, 0, 0.8}}, {2, 4, 7}));
    for (Mesh &mesh : meshes)
        if (black_lights && mesh.radiance)
            mesh.bsdf = diffuse(0);
    SceneDescription scene = scene_of(std::move(meshes));
    scene.camera = camera({0.1, 0.05, -0.97}, {0, -0.1, 1}, width, height, 85);
    return scene;
}

} // namespace

Camera camera(Vec3 from, Vec3 to, int width, int height, double fov) {
    Camera camera = examples::camera(from, to, fov);
    camera.width = width;
    camera.height = height;
    return camera;
}

SceneDescription furnace(double albedo, double emitted) {
    Mesh walls = diffuse(cube({}, 1, true), float(albedo));
    walls.radiance = Color{emitted, emitted, emitted};
    SceneDescription scene = scene_of({walls});
    scene.camera = camera({0.1, 0.2, -0.3}, {0.3, 0, 1}, 8, 8, 70);
    return scene;
}

SceneDescription glass_furnace() {
    SceneDescription scene = furnace(0, 1);
    const TriangleMesh tetrahedron =
        mesh_of({{-0.8, -0.7, -0.6}, {0.9, -0.6, -0.7}, {0.1, -0.5, 0.95}, {0.15, 0.85, -0.1}},
                {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}});
    scene.meshes.push_back(made_of(tetrahedron, examples::dielectric()));
    scene.camera = camera({0.1, -0.3, -0.2}, {0.3, 0, 1}, 8, 8, 70);
    return scene;
}

SceneDescription triangle_light() {
    SceneDescription scene = scene_of(
        {diffuse(Parallelogram{{-3, 0, -3}, {0, 0, 6}, {6, 0, 0}}, float(floor_albedo), true),
         light(mesh_of({light_corners[0], light_corners[1], light_corners[2]}, {{0, 1, 2}}), {light_red, 2, 1})});
    scene.camera = camera({2, 1.5, -2}, floor_point, 4, 4, 1e-3);
    scene.strategy.max_depth = 2;
    return scene;
}

double triangle_light_truth() {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const Vec3 a = normalize(light_corners[i] - floor_point),
                   b = normalize(light_corners[(i + 1) % 3] - floor_point);
        sum += std::acos(dot(a, b)) * normalize(cross(a, b)).y;
    }
    return floor_albedo / std::numbers::pi * light_red / 2 * std::abs(sum);
}

SceneDescription averted_light() {
    SceneDescription scene = triangle_light();
    std::swap(std::get<TriangleMesh>(scene.meshes[1].shape).positions[1],
              std::get<TriangleMesh>(scene.meshes[1].shape).positions[2]);
    return scene;
}

SceneDescription round_furnace(double albedo, double emitted) {
    SceneDescription scene = furnace(albedo, emitted);
    for (Mesh &mesh : scene.meshes)
        mesh.shape = Sphere{{}, 1, true};
    return scene;
}

SceneDescription sphere_light(double radius) {
    const Vec3 center = floor_point + Vec3{0.4, 1.1, -0.2};
    const double distance = length(center - floor_point), red = std::pow(distance / radius, 2);
    SceneDescription scene = scene_of(
        {diffuse(Parallelogram{center + Vec3{-3, -1.1, -3}, {0, 0, 6}, {6, 0, 0}}, float(floor_albedo), true),
         light(Sphere{center, radius}, {red, red / 2, red / 3}), diffuse(Sphere{center + Vec3{2.5, 1, 2.5}, 0.1})});
    scene.camera = camera({2, 1.5, -2}, floor_point, 4, 4, 1e-3);
    scene.strategy.max_depth = 2;
    return scene;
}

double sphere_light_truth() { return floor_albedo * 1.1 / length(Vec3{0.4, 1.1, -0.2}); }

Vec3 smooth_normal() { return normalize({0.5, 0.3, 0.2}); }

SceneDescription smooth_octahedron() {
    const Vec3 center{0.3, -0.2, 0.1};
    SceneDescription scene = scene_of({made_of(octahedron(center, 0.7), diffuse(0.5))});
    scene.strategy[AXIS_integrator] = CHOICE_integrator_normals;
    scene.camera = camera({2, 1.5, 1}, center + Vec3{0.5, 0.3, 0.2} * 0.7, 4, 4, 1e-3);
    return scene;
}

SceneDescription point_light() {
    SceneDescription scene = triangle_light();
    scene.meshes.pop_back();
    scene.lights = {{emitter_point{{0.5, 1.5, 0.9}, {100, 50, 20}}, {}}};
    return scene;
}

double point_light_truth() {
    const Vec3 d = Vec3{0.5, 1.5, 0.9} - floor_point;
    return floor_albedo / std::numbers::pi * 100 / (4 * std::numbers::pi) * d.y / std::pow(length(d), 3);
}

SceneDescription reflection(float index) {
    SceneDescription scene = scene_of({made_of(quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), examples::dielectric(index)),
                                       light(Parallelogram{{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}}, {1, 1, 1})});
    scene.camera = camera({0, 1, 0}, {0, 0, 0}, 1, 1, 1e-3);
    scene.strategy.max_depth = 2;
    return scene;
}

SceneDescription gallery(int width, int height) {
    return room({made_of(quad({0.98, -0.6, -0.2}, {0, 0, 0.8}, {0, 0.9, 0}), examples::mirror()),
                 made_of(quad({-0.8, -0.7, 0.97}, {0, 0.9, 0}, {0.8, 0, 0}), examples::microfacet(0.2, 0.3)),
                 made_of(quad({-0.8, -0.97, -0.6}, {0, 0, 0.9}, {0.8, 0, 0}), examples::phong(20, 0.7)),
                 made_of(cube({0.35, -0.6, 0.3}, 0.25), examples::dielectric()),
                 made_of(octahedron({-0.4, -0.5, 0.3}, 0.35), diffuse(0.7))},
                width, height, false);
}

SceneDescription matte_gallery(int width, int height) {
    return room({made_of(quad({-0.8, -0.7, 0.97}, {0, 0.9, 0}, {0.8, 0, 0}), examples::microfacet(0.2, 0.3)),
                 made_of(quad({-0.8, -0.97, -0.6}, {0, 0, 0.9}, {0.8, 0, 0}), examples::phong(20, 0.7)),
                 made_of(cube({0.35, -0.6, 0.3}, 0.25), diffuse(0.5)),
                 made_of(octahedron({-0.4, -0.5, 0.3}, 0.35), diffuse(0.7))},
                width, height, true);
}

} // namespace opal::test
