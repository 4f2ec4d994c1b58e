#include "selftest/brute_force.h"

#include "scene/examples.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace opal {

namespace {

// Where a ray meets a triangle's plane (Moeller and Trumbore 1997).
struct PlaneHit {
    double t, u, v;
    double inside; // the smallest barycentric weight: below 0 outside the triangle
    double slack;  // how far single precision may put t: the rounding of the triangle's place over the ray's cosine
};

constexpr double rounding = 0x1p-19; // of a coordinate up to 4 after a few operations in single precision

PlaneHit meet(const HostRay &ray, const std::array<Vec3, 3> &p) {
    const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0], h = cross(ray.d, e2), s = ray.o - p[0], q = cross(s, e1);
    const double determinant = dot(e1, h), u = dot(s, h) / determinant, v = dot(ray.d, q) / determinant;
    const double across = std::abs(determinant) / length(cross(e1, e2)); // |n . d|
    return {dot(e2, q) / determinant, u, v, std::min({u, v, 1 - u - v}), rounding / across};
}

constexpr double doubt = 1e-4; // relative distance to an edge or a bound below which either answer is right

// Where a ray's line enters and leaves a sphere, with u = 0 and u = 1. It may miss it: inside < 0.
std::array<PlaneHit, 2> meet(const HostRay &ray, const SlotSphere &sphere) {
    const Vec3 f = ray.o - sphere.center;
    const double speed = length(ray.d), to_nearest = -dot(f, ray.d) / (speed * speed);
    const double away = length(f + ray.d * to_nearest), half2 = sphere.radius * sphere.radius - away * away;
    const double half = std::sqrt(std::max(half2, 0.0)) / speed;
    // Of the smallest spheres single precision moves the edge by more than `doubt` of their radius.
    const double inside = (sphere.radius - away) / std::max(sphere.radius, rounding / doubt);
    // Where the line grazes, the chord's ends are as far off as those of one that lies deeper by the rounding.
    const double least_half = std::sqrt(rounding * sphere.radius);
    const double slack = rounding * sphere.radius / std::max(half * speed, least_half) / speed;
    return {{{to_nearest - half, 0, 0, inside, slack}, {to_nearest + half, 1, 0, inside, slack}}};
}

// Adds to `errors` what is wrong with the device's answer `i`.
void judge(const HostRay &ray, const std::vector<SlotTriangle> &triangles, const std::vector<SlotSphere> &spheres,
           const Planes &found, size_t i, HitErrors &errors) {
    double sure = INFINITY, possible = INFINITY; // the farthest and the nearest that the nearest hit may be
    bool own = false, wrong_weights = false;     // the device's hit is one of those that may be; its u and v are not
    const uint slot = found.bits(HIT_SLOT, i);
    const double t = found.at(HIT_T, i);
    const auto add = [&](const PlaneHit &m, uint its_slot) {
        const double slack = std::max(doubt * m.t, m.slack);
        if (m.inside > doubt && m.t > ray.tmin + slack && m.t < ray.tmax - slack)
            sure = std::min(sure, m.t + slack);
        if (m.inside > -doubt && m.t > ray.tmin - slack && m.t < ray.tmax + slack) {
            possible = std::min(possible, m.t - slack);
            if (its_slot == slot && std::abs(m.t - t) <= slack) {
                own = true;
                wrong_weights =
                    std::abs(m.u - found.at(HIT_U, i)) > 10 * doubt || std::abs(m.v - found.at(HIT_V, i)) > 10 * doubt;
            }
        }
    };
    for (const SlotTriangle &triangle : triangles)
        add(meet(ray, triangle.corners), triangle.slot);
    for (const SlotSphere &sphere : spheres)
        for (const PlaneHit &m : meet(ray, sphere))
            add(m, sphere.slot);
    errors.weights += wrong_weights;
    const bool hit = slot != OPAL_NONE, any = found.at(HIT_ANY, i) != 0;
    errors.hits += hit;
    errors.closest += hit ? !own || t > sure || t < possible : std::isfinite(sure);
    errors.any += any ? !std::isfinite(possible) : std::isfinite(sure);
}

} // namespace

std::vector<SlotTriangle> triangles_by_slot(const FlatScene &scene) {
    std::vector<SlotTriangle> triangles;
    for (uint slot = 0; slot < 8 * scene.triangle_blocks.size(); slot++)
        if (const TriangleBlock &block = scene.triangle_blocks[slot / 8]; block.id[slot % 8] != OPAL_NONE) {
            SlotTriangle triangle{slot, {}};
            for (int c = 0; c < 3; c++)
                triangle.corners[size_t(c)] = {block.vertex[c][0][slot % 8], block.vertex[c][1][slot % 8],
                                               block.vertex[c][2][slot % 8]};
            triangles.push_back(triangle);
        }
    return triangles;
}

std::vector<SlotSphere> spheres_by_slot(const FlatScene &scene) {
    std::vector<SlotSphere> spheres;
    for (uint slot = 0; slot < 8 * scene.sphere_blocks.size(); slot++) {
        const SphereBlock &block = scene.sphere_blocks[slot / 8];
        const uint place = slot % 8;
        if (block.id[place] != OPAL_NONE)
            spheres.push_back(
                {slot, {block.center[0][place], block.center[1][place], block.center[2][place]}, block.radius[place]});
    }
    return spheres;
}

Planes planes_of_rays(std::vector<HostRay> &rays) {
    Planes planes(RAY_PLANES, rays.size());
    for (size_t i = 0; i < rays.size(); i++) {
        HostRay &r = rays[i];
        const double values[RAY_PLANES] = {r.o.x, r.o.y, r.o.z, r.d.x, r.d.y, r.d.z, r.tmin, r.tmax};
        for (size_t plane = 0; plane < RAY_PLANES; plane++)
            planes.at(plane, i) = float(values[plane]);
        r = {planes.vec3(RAY_O_X, i), planes.vec3(RAY_D_X, i), planes.at(RAY_TMIN, i), planes.at(RAY_TMAX, i)};
    }
    return planes;
}

std::vector<HostRay> random_rays(size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<HostRay> rays;
    for (size_t i = 0; i < count; i++) {
        Vec3 d{uniform(random), uniform(random), uniform(random)};
        if (i % 8 == 1)
            d.x = 0;
        if (i % 8 == 2)
            d = {0, 0, d.z};
        if (i % 8 == 3)
            d = {d.x, -0.0, 0};
        d = d * std::exp(3 * uniform(random));
        const double reach = i % 4 == 0 ? 1e30 : 1 / length(d);
        rays.push_back({{uniform(random), uniform(random), uniform(random)},
                        d,
                        i % 3 ? 0 : 0.2 / length(d),
                        reach * (1 + uniform(random) / 2)});
    }
    return rays;
}

HitErrors errors_of_hits(KernelProbe &probe, std::vector<HostRay> rays) {
    const Planes found = probe.trace(planes_of_rays(rays));
    const std::vector<SlotTriangle> triangles = triangles_by_slot(probe.scene());
    const std::vector<SlotSphere> spheres = spheres_by_slot(probe.scene());
    HitErrors errors;
    for (size_t i = 0; i < rays.size(); i++)
        judge(rays[i], triangles, spheres, found, i, errors);
    return errors;
}

size_t lost_among(KernelProbe &probe, std::vector<HostRay> rays) {
    const Planes found = probe.trace(planes_of_rays(rays));
    size_t lost = 0;
    for (size_t i = 0; i < rays.size(); i++)
        lost += found.bits(HIT_SLOT, i) == OPAL_NONE || found.at(HIT_ANY, i) == 0;
    return lost;
}

SceneDescription triangle_soup(size_t triangles, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Vec3> positions;
    std::vector<std::array<unsigned, 3>> corners;
    for (unsigned i = 0; i < triangles; i++) {
        const Vec3 p{uniform(random), uniform(random), uniform(random)};
        for (int corner = 0; corner < 3; corner++)
            positions.push_back(p + Vec3{uniform(random), uniform(random), uniform(random)} * size);
        corners.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return scene_of_mesh(examples::mesh_of(std::move(positions), corners));
}

SceneDescription sphere_soup(size_t spheres, double least, double most, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1), size(std::log(least), std::log(most));
    SceneDescription scene;
    for (size_t i = 0; i < spheres; i++) {
        const Vec3 center{uniform(random), uniform(random), uniform(random)};
        scene.meshes.push_back(examples::made_of(Sphere{center, std::exp(size(random)), i % 2 == 0}, Bsdf()));
    }
    return scene;
}

SceneDescription scene_of_mesh(TriangleMesh mesh) {
    SceneDescription scene;
    scene.meshes.resize(1);
    scene.meshes[0].shape = std::move(mesh);
    return scene;
}

} // namespace opal
