// Closest and any hit of the kernels against every triangle in double; rays at edges and along walls.
#include "selftest/watertight.h"
#include "support/kernel_checks.h"
#include "support/plain_scenes.h"
#include "support/probe.h"
#include "support/rooms.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace opal::test {

namespace {

// Convex quadrilaterals of two triangles each, whose corners begin anywhere.
SceneDescription quadrilaterals(size_t count, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    TriangleMesh mesh;
    const auto add = [&](std::array<unsigned, 3> corners) {
        std::rotate(corners.begin(), corners.begin() + int(random() % 3), corners.end());
        mesh.triangles.push_back({{{corners[0], OPAL_NONE}, {corners[1], OPAL_NONE}, {corners[2], OPAL_NONE}}});
    };
    for (unsigned i = 0; i < count; i++) {
        const Vec3 p{uniform(random), uniform(random), uniform(random)};
        const Vec3 u = Vec3{uniform(random), uniform(random), uniform(random)} * size,
                   v = Vec3{uniform(random), uniform(random), uniform(random)} * size;
        const double far_u = 0.8 + 0.4 * uniform(random),
                     far_v = 0.8 + 0.4 * uniform(random) + (1.2 - far_u); // their sum is above 1
        mesh.positions.insert(mesh.positions.end(), {p, p + u, p + v, p + u * far_u + v * far_v});
        add({4 * i, 4 * i + 1, 4 * i + 2});
        add({4 * i + 3, 4 * i + 2, 4 * i + 1});
    }
    return scene_of({diffuse(mesh)});
}

Findings compare_all(const std::string &what, const SceneDescription &scene, const std::vector<int> &widths,
                     const Sources &sources, unsigned seed) {
    Findings findings;
    for (int lanes : widths) {
        const FlatScene flat = flatten(scene, lanes);
        KernelProbe probe = probe_of(flat, lanes, sources);
        constexpr size_t rays = 6000;
        const HitErrors errors = errors_of_hits(probe, random_rays(rays, seed));
        const std::string where = what + at_width(lanes);
        findings.push_back(none_wrong("closest hits", double(errors.closest), where));
        findings.push_back(none_wrong("any-hits", double(errors.any), where));
        findings.push_back(none_wrong("barycentric weights", double(errors.weights), where));
        findings.push_back(
            exact(where + ": many rays hit, many miss", errors.hits > rays / 20 && errors.hits < rays * 19 / 20));
    }
    return findings;
}

// A closed cylinder with few large triangles at its ends and many small ones around.
TriangleMesh drum(int rows, int segments) {
    TriangleMesh mesh;
    const auto corner = [](unsigned i) { return TriangleMesh::Corner{i, OPAL_NONE}; };
    const auto at = [&](int i, int j) { return corner(unsigned(i * segments + j % segments)); };
    for (int i = 0; i <= rows; i++)
        for (int j = 0; j < segments; j++) {
            const double phi = 2 * std::numbers::pi * j / segments;
            mesh.positions.push_back({std::cos(phi), std::sin(phi), 1.6 * i / rows - 0.8});
        }
    for (int j = 0; j < segments; j++) {
        for (int i = 0; i < rows; i++) {
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
            mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
        if (j > 0 && j < segments - 1) {
            mesh.triangles.push_back({at(0, 0), at(0, j + 1), at(0, j)});
            mesh.triangles.push_back({at(rows, 0), at(rows, j), at(rows, j + 1)});
        }
    }
    return mesh;
}

// Askew, so that the boxes of long triangles are mostly empty, and as large still.
TriangleMesh turned(TriangleMesh mesh) {
    const Transform turn = Transform::scale({0.75, 0.75, 0.75}) * Transform::rotate({1, 2, 3}, 40);
    for (auto &p : mesh.positions)
        p = turn.point(p);
    return mesh;
}

// Rays from the middle of a closed mesh, and from points of the x axis, towards its vertices and points of its edges.
std::vector<HostRay> rays_from_axis(const FlatScene &flat, size_t count, std::mt19937 &random) {
    const std::vector<SlotTriangle> triangles = triangles_by_slot(flat);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<HostRay> rays;
    for (size_t i = 0; i < count; i++) {
        const SlotTriangle &triangle = triangles[random() % triangles.size()];
        const Vec3 a = triangle.corners[random() % 3], b = triangle.corners[random() % 3]; // often the same: a vertex
        const Vec3 from = {i % 2 ? 0.3 * uniform(random) : 0, 0, 0};
        const double s = i % 4 < 2 ? 0.5 : 0.5 + uniform(random) / 2;
        rays.push_back({from, a * s + b * (1 - s) - from, 0, 1e30});
    }
    return rays;
}

Finding no_leaks(const std::string &what, const TriangleMesh &mesh, int lanes, const Sources &sources, unsigned seed) {
    const FlatScene flat = flatten(scene_of({diffuse(mesh)}), lanes);
    std::mt19937 random(seed);
    KernelProbe probe = probe_of(flat, lanes, sources);
    const size_t lost = edges::lost_rays(probe, 40000, random) + lost_among(probe, rays_from_axis(flat, 20000, random));
    return none_wrong("rays lost at edges and vertices", double(lost), what + at_width(lanes));
}

// Rays inside a cube, nearly parallel to its walls and as close to them as rays start (surface.cl). Each must hit
// something, and not beyond the cube.
Finding along_walls(int lanes, const Sources &sources, unsigned seed) {
    const FlatScene flat = flatten(scene_of({diffuse(cube({}, 1))}), lanes);
    double half = 0;
    for (const SlotTriangle &triangle : triangles_by_slot(flat))
        half = std::max(half, triangle.corners[0].x);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<HostRay> rays;
    for (size_t i = 0; i < 40000; i++) {
        const double wall = (i % 2 ? 1 : -1) * half * (1 - 0x1p-24 * double(24 + random() % 8)),
                     slope = 0x1p-24 * (double(random() % 15) - 7);
        const double a = half * uniform(random), b = half * uniform(random), u = uniform(random),
                     v = i % 5 ? uniform(random) : 0;
        const size_t axis = random() % 3;
        const Vec3 from[] = {{wall, a, b}, {b, wall, a}, {a, b, wall}},
                   to[] = {{slope, u, v}, {v, slope, u}, {u, v, slope}};
        rays.push_back({from[axis], to[axis], 0, 1e30});
    }
    const Planes found = probe_of(flat, lanes, sources).trace(planes_of_rays(rays));
    constexpr double slack = 1e-4; // the slopes cannot leave the cube by more
    size_t wrong = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        double exit = INFINITY;
        for (const auto &[o, d] :
             {std::pair{rays[i].o.x, rays[i].d.x}, {rays[i].o.y, rays[i].d.y}, {rays[i].o.z, rays[i].d.z}})
            if (std::abs(d) > 1e-5)
                exit = std::min(exit, ((d > 0 ? half : -half) - o) / d);
        wrong += found.bits(HIT_SLOT, i) == OPAL_NONE || found.at(HIT_ANY, i) == 0 ||
                 !(found.at(HIT_T, i) <= exit * (1 + slack) + slack);
    }
    return none_wrong("rays along a cube's walls end nowhere, or outside", double(wrong), "a cube" + at_width(lanes));
}

// Spheres that lie apart, with radii over seven decades: each in a cell of a grid over [-1, 1]^3.
SceneDescription spheres_apart(unsigned seed) {
    constexpr int side = 10;
    constexpr double half_cell = 1.0 / side;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    SceneDescription scene;
    for (int cell = 0; cell < side * side * side; cell++) {
        const double radius = 0.9 * half_cell * std::pow(10, -7 * uniform(random));
        Vec3 center{};
        for (double *axis : {&center.x, &center.y, &center.z})
            *axis = (2 * uniform(random) - 1) * (half_cell - radius);
        const Vec3 corner = Vec3{double(cell % side), double(cell / side % side), double(cell / side / side)};
        center = center + corner * (2 * half_cell) + Vec3{1, 1, 1} * (half_cell - 1);
        scene.meshes.push_back(diffuse(Sphere{center, radius, cell % 2 == 0}));
    }
    return scene;
}

Vec3 random_direction(std::mt19937 &random) {
    std::normal_distribution<double> normal;
    return normalize({normal(random), normal(random), normal(random)});
}

// A unit vector across a unit vector.
Vec3 across(Vec3 n, std::mt19937 &random) { return normalize(cross(n, random_direction(random))); }

// A number in (0, 1) that is often tiny.
double tiny(std::mt19937 &random) { return std::pow(10, -8 * std::uniform_real_distribution<double>(0, 1)(random)); }

// Rays meet spheres, half of them at a grazing angle, and leave in directions of which half graze again. Those that
// start outside must not meet the same sphere, those that start inside must.
Findings leave_spheres(const std::string &what, const SceneDescription &scene, size_t count, int lanes,
                       const Sources &sources, unsigned seed) {
    const FlatScene flat = flatten(scene, lanes);
    const std::vector<SlotSphere> spheres = spheres_by_slot(flat);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<HostRay> rays;
    for (size_t i = 0; i < count; i++) {
        const SlotSphere &sphere = spheres[random() % spheres.size()];
        const Vec3 far{uniform(random) * 3, uniform(random) * 3, uniform(random) * 3};
        const Vec3 from = i % 4 == 3 ? sphere.center + random_direction(random) * (sphere.radius / 2) : far;
        const double aside = sphere.radius * std::sqrt(1 - (i % 2 ? std::abs(uniform(random)) : tiny(random)));
        const Vec3 to = sphere.center + across(normalize(sphere.center - from), random) * aside;
        rays.push_back({from, to - from, 0, 1e30});
    }
    KernelProbe probe = probe_of(flat, lanes, sources);
    const Planes met = probe.trace(planes_of_rays(rays));
    std::vector<HostRay> leaving;
    std::vector<uint> left;     // the sphere of each
    std::vector<bool> outwards; // whether it starts outside
    for (size_t i = 0; i < met.count; i++) {
        const uint slot = met.bits(HIT_SLOT, i);
        if (slot == OPAL_NONE)
            continue;
        const SphereBlock &block = flat.sphere_blocks[slot / 8];
        const Vec3 n = met.vec3(HIT_NORMAL_X, i);
        const double rise = (random() % 2 ? 1 : tiny(random)) * uniform(random), offset = met.at(HIT_RAY_OFFSET, i);
        HostRay ray{{}, normalize(across(n, random) + n * rise), 0, 1e30};
        // As leave_surface(), whose choice is rounding in a direction along the surface.
        const double slope = dot(n, ray.d), side = std::abs(slope) < 1e-7 && random() % 2 ? -slope : slope;
        ray.o = met.vec3(HIT_P_X, i) + n * std::copysign(offset, side);
        const bool out = (side > 0) != (block.inward[slot % 8] != 0);
        if (!out && block.radius[slot % 8] < 4 * offset)
            continue; // single precision has no point inside
        leaving.push_back(ray);
        left.push_back(slot);
        outwards.push_back(out);
    }
    const Planes again = probe.trace(planes_of_rays(leaving));
    size_t shadowed = 0, lost = 0, out = 0;
    for (size_t i = 0; i < again.count; i++) {
        const bool own = again.bits(HIT_SLOT, i) == left[i];
        out += outwards[i];
        shadowed += outwards[i] && own;
        lost += !outwards[i] && !(own && again.at(HIT_U, i) > 0.5 && again.at(HIT_ANY, i) == 1);
    }
    const std::string where = what + at_width(lanes);
    return {none_wrong("rays that leave a sphere and meet it", double(shadowed), where),
            none_wrong("rays inside a sphere that do not end there", double(lost), where),
            exact(where + ": many rays start outside, many inside", out > count / 5 && again.count - out > count / 5)};
}

} // namespace

Findings check_spheres(const Sources &sources, unsigned seed) {
    SceneDescription mixed = sphere_soup(150, 1e-2, 0.3, seed), triangles = triangle_soup(300, 0.15, seed + 1);
    mixed.meshes.insert(mixed.meshes.begin() + 70, triangles.meshes[0]);
    Findings findings =
        compare_all("300 spheres", sphere_soup(300, 1e-3, 0.4, seed + 2), tested_lanes(), sources, seed + 3);
    append(findings, compare_all("spheres and triangles", mixed, tested_lanes(), sources, seed + 4));
    SceneDescription alone;
    alone.meshes = {diffuse(Sphere{{0.3, -0.2, 7}, 1e3})};
    for (int lanes : tested_lanes()) {
        const size_t count = lanes == 1 ? 100'000 : 500'000;
        append(findings, leave_spheres("1000 spheres apart", spheres_apart(seed + 5), count, lanes, sources, seed + 6));
        append(findings, leave_spheres("a sphere alone", alone, count, lanes, sources, seed + 7));
    }
    return findings;
}

Findings check_tree(const Sources &sources, unsigned seed) {
    Findings findings =
        compare_all("1500 triangles", triangle_soup(1500, 0.15, seed), tested_lanes(), sources, seed + 1);
    append(findings, compare_all("60 large triangles", triangle_soup(60, 1, seed + 2), {device().info.native_lanes},
                                 sources, seed + 3));
    return findings;
}

Findings check_tiny(const Sources &sources, unsigned seed) {
    const SceneDescription triangles = triangle_soup(30, 0.8, seed), pairs = quadrilaterals(20, 0.8, seed + 2);
    const FlatScene listed = flatten(pairs, 4);
    Findings findings = {exact("30 triangles need no tree", !flatten(triangles, 4).features[FEATURE_tree]),
                         exact("nor do 20 quadrilaterals, most of them plane as floats have them",
                               !listed.features[FEATURE_tree] && listed.faces.size() < 30)};
    append(findings, compare_all("30 triangles", triangles, {4, 16}, sources, seed + 1));
    append(findings, compare_all("20 quadrilaterals", pairs, {4, 16}, sources, seed + 3));
    return findings;
}

Findings check_watertight(const Sources &sources, unsigned seed) {
    const TriangleMesh slats = turned(drum(1, 200));
    Findings findings = {
        exact("slats are in the tree in parts",
              triangles_by_slot(flatten(scene_of({diffuse(slats)}), 4)).size() > slats.triangles.size())};
    for (int lanes : tested_lanes())
        for (const auto &[what, mesh] : {std::pair{"a ball", edges::closed_sphere(20, 31)},
                                         {"a cube", cube({}, 1)},
                                         {"a crystal", edges::closed_sphere(3, 7)},
                                         {"a drum", drum(30, 24)},
                                         {"slats", slats}})
            findings.push_back(no_leaks(what, mesh, lanes, sources, seed));
    for (int lanes : tested_lanes())
        findings.push_back(along_walls(lanes, sources, seed));
    return findings;
}

} // namespace opal::test
