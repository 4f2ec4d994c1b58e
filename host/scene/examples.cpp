#include "scene/examples.h"

#include <cmath>
#include <numbers>

namespace opal::examples {

Camera camera(Vec3 from, Vec3 to, double fov) {
    Camera camera;
    const Vec3 d = normalize(to - from);
    camera.to_world = Transform::look_at(from, to, std::abs(d.y) > 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0});
    camera.perspective.fov = fov;
    camera.near_clip = 0;
    camera.far_clip = 1e30;
    return camera;
}

Bsdf diffuse(double albedo, bool use_cosine) { return bsdf_diffuse_record{.albedo = albedo, .use_cosine = use_cosine}; }

Bsdf mirror() { return bsdf_mirror_record{}; }

Bsdf dielectric(double int_ior) { return bsdf_dielectric_record{.int_ior = int_ior, .ext_ior = 1}; }

Bsdf microfacet(double alpha, double kd) {
    return bsdf_microfacet_record{.alpha = alpha, .int_ior = 1.5, .ext_ior = 1, .kd = kd};
}

Bsdf principled(double roughness) {
    return bsdf_principled_record{.base_color = 0.5,
                                  .roughness = roughness,
                                  .metallic = 0.5,
                                  .spec_trans = 0.5,
                                  .clearcoat = 1,
                                  .clearcoat_gloss = 1};
}
Bsdf phong(double exponent, double reflectance) {
    return bsdf_phong_record{.kd = reflectance, .ks = reflectance, .n = exponent};
}

TriangleMesh mesh_of(const std::vector<Vec3> &positions, const std::vector<std::array<unsigned, 3>> &triangles) {
    TriangleMesh mesh;
    mesh.positions.assign(positions.begin(), positions.end());
    for (const auto &[a, b, c] : triangles)
        mesh.triangles.push_back({{{a, OPAL_NONE}, {b, OPAL_NONE}, {c, OPAL_NONE}}});
    return mesh;
}

TriangleMesh quad(Vec3 o, Vec3 u, Vec3 v) { return mesh_of({o, o + u, o + u + v, o + v}, {{0, 1, 2}, {0, 2, 3}}); }

TriangleMesh cube(Vec3 center, double half_side, bool inwards) {
    const double s = half_side;
    std::vector<Vec3> corners;
    for (unsigned i = 0; i < 8; i++)
        corners.push_back(center + Vec3{i & 1 ? s : -s, i & 2 ? s : -s, i & 4 ? s : -s});
    const unsigned faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}; // outwards
    std::vector<std::array<unsigned, 3>> triangles;
    for (const auto &f : faces)
        for (unsigned i : {1u, 2u})
            triangles.push_back(inwards ? std::array{f[0], f[i + 1], f[i]} : std::array{f[0], f[i], f[i + 1]});
    return mesh_of(std::move(corners), triangles);
}

Mesh made_of(Shape shape, const Bsdf &bsdf) {
    Mesh mesh;
    mesh.shape = std::move(shape);
    mesh.bsdf = bsdf;
    return mesh;
}

Mesh light(Shape shape, double radiance) {
    Mesh mesh = made_of(std::move(shape), diffuse(0));
    mesh.radiance = Color{radiance, radiance, radiance};
    return mesh;
}

std::shared_ptr<const EnvironmentMap> environment() {
    constexpr double pi = std::numbers::pi;
    constexpr int width = 16, height = 9;
    const Vec3 sun = normalize({0.5, 0.6, 0.4});
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.channels = 3;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double theta = pi * y / (height - 1), phi = 2 * pi * (x + 0.5) / width;
            const Vec3 d{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
            const double glow = 20 * std::exp(12 * (dot(d, sun) - 1)), sky = d.y > 0 ? 1 : 0.1;
            for (double color : {0.4 * sky + 1.0 * glow, 0.6 * sky + 0.9 * glow, 1.0 * sky + 0.7 * glow})
                picture.floats.push_back(float(color));
        }
    return environment_of(std::move(picture), "an example");
}

} // namespace opal::examples
