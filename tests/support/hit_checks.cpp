// Closest and any hit of the kernels against every triangle in double.
#include "probe/kernel_probe.h"
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/plain_scenes.h"
#include "support/rooms.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace opal::test {

namespace {

struct HostRay {
    Vec3 o, d;
    double tmin, tmax;
};

// Where a ray meets a triangle's plane, and by how much it lies inside: the smallest barycentric weight. `slack` is how
// far single precision may put t: the rounding of the triangle's place, over the cosine at which the ray meets it.
struct Meeting {
    double t, inside, u, v, slack;
};

constexpr double rounding = 0x1p-19; // of a coordinate up to 4 after a few operations in single precision

Meeting meet(const HostRay &ray, const std::array<Vec3, 3> &p) {
    const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0], h = cross(ray.d, e2), s = ray.o - p[0], q = cross(s, e1);
    const double determinant = dot(e1, h), u = dot(s, h) / determinant, v = dot(ray.d, q) / determinant;
    const double across = std::abs(determinant) / length(cross(e1, e2)); // |n . d|
    return {dot(e2, q) / determinant, std::min({u, v, 1 - u - v}), u, v, rounding / across};
}

struct Slot {
    uint slot;
    std::array<Vec3, 3> p;
};

std::vector<Slot> triangles_of(const FlatScene &scene) {
    std::vector<Slot> slots;
    for (uint slot = 0; slot < 8 * scene.blocks.size(); slot++)
        if (scene.blocks[slot / 8].id[slot % 8] != OPAL_NONE) {
            std::array<Vec3, 3> p;
            for (int corner = 0; corner < 3; corner++) {
                const auto x = vertex(scene, slot, corner);
                p[size_t(corner)] = {x[0], x[1], x[2]};
            }
            slots.push_back({slot, p});
        }
    return slots;
}

Planes planes_of_rays(std::vector<HostRay> &rays) {
    Planes planes(RAY_PLANES, rays.size());
    for (size_t i = 0; i < rays.size(); i++) {
        HostRay &r = rays[i];
        const double values[RAY_PLANES] = {r.o.x, r.o.y, r.o.z, r.d.x, r.d.y, r.d.z, r.tmin, r.tmax};
        for (size_t plane = 0; plane < RAY_PLANES; plane++)
            planes.at(plane, i) = float(values[plane]);
        r = {planes.vec3(RAY_O_X, i), planes.vec3(RAY_D_X, i), planes.at(RAY_TMIN, i),
             planes.at(RAY_TMAX, i)}; // as rounded
    }
    return planes;
}

// In the flattened scene, about [-1, 1]^3: directions of any length, along axes and planes too, with near and far
// bounds.
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

// Rays too near an edge or a bound to say are not judged, but for what all triangles agree on.
constexpr double doubt = 1e-4;

struct Counts {
    size_t wrong_closest = 0, wrong_any = 0, wrong_place = 0, hits = 0;
};

Counts compare(const FlatScene &scene, const std::vector<HostRay> &rays, const Planes &found) {
    const std::vector<Slot> triangles = triangles_of(scene);
    Counts counts;
    for (size_t i = 0; i < rays.size(); i++) {
        const HostRay &ray = rays[i];
        double sure = INFINITY, possible = INFINITY; // farthest that the nearest hit may be, nearest that it may be
        bool own = false;                            // what the kernel says is one of those that may
        const uint slot = found.bits(HIT_SLOT, i);
        const double t = found.at(HIT_T, i);
        for (const Slot &triangle : triangles) {
            const Meeting m = meet(ray, triangle.p);
            const double slack = std::max(doubt * m.t, m.slack);
            if (m.inside > doubt && m.t > ray.tmin + slack && m.t < ray.tmax - slack)
                sure = std::min(sure, m.t + slack);
            if (m.inside > -doubt && m.t > ray.tmin - slack && m.t < ray.tmax + slack) {
                possible = std::min(possible, m.t - slack);
                if (triangle.slot == slot) {
                    own = std::abs(m.t - t) <= slack;
                    counts.wrong_place += std::abs(m.u - found.at(HIT_U, i)) > 10 * doubt ||
                                          std::abs(m.v - found.at(HIT_V, i)) > 10 * doubt;
                }
            }
        }
        const bool hit = slot != OPAL_NONE;
        counts.hits += hit;
        counts.wrong_closest += hit ? !own || t > sure || t < possible : std::isfinite(sure);
        const bool any = found.at(HIT_ANY, i) != 0;
        counts.wrong_any += any ? !std::isfinite(possible) : std::isfinite(sure);
    }
    return counts;
}

SceneDescription soup(size_t triangles, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    TriangleMesh mesh;
    for (unsigned i = 0; i < triangles; i++) {
        const Vec3 p{uniform(random), uniform(random), uniform(random)};
        for (int corner = 0; corner < 3; corner++)
            mesh.positions.push_back(p + Vec3{uniform(random), uniform(random), uniform(random)} * size);
        mesh.triangles.push_back({{{3 * i, OPAL_NONE}, {3 * i + 1, OPAL_NONE}, {3 * i + 2, OPAL_NONE}}});
    }
    return scene_of({diffuse(mesh)});
}

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

KernelProbe probe_of(const FlatScene &flat, int lanes, const Sources &sources) {
    BuildOptions build;
    build.lanes = lanes;
    return KernelProbe(device(), flat, build, sources);
}

Findings compare_all(const std::string &what, const SceneDescription &scene, const std::vector<int> &widths,
                     const Sources &sources, unsigned seed) {
    Findings findings;
    for (int lanes : widths) {
        const FlatScene flat = flatten(scene, lanes);
        std::vector<HostRay> rays = random_rays(6000, seed);
        const Planes planes = planes_of_rays(rays);
        const Counts counts = compare(flat, rays, probe_of(flat, lanes, sources).trace(planes));
        const std::string where = what + " at " + std::to_string(lanes) + " lanes: ";
        findings.push_back(
            exact(where + std::to_string(counts.wrong_closest) + " closest hits wrong", counts.wrong_closest == 0));
        findings.push_back(exact(where + std::to_string(counts.wrong_any) + " any-hits wrong", counts.wrong_any == 0));
        findings.push_back(
            exact(where + std::to_string(counts.wrong_place) + " barycentric weights wrong", counts.wrong_place == 0));
        findings.push_back(exact(where + "many rays hit, many miss",
                                 counts.hits > rays.size() / 20 && counts.hits < rays.size() * 19 / 20));
    }
    return findings;
}

// A sphere of triangles, every vertex once.
TriangleMesh ball(int rings, int segments) {
    TriangleMesh mesh;
    for (int i = 0; i <= rings; i++)
        for (int j = 0; j < segments; j++)
            if ((i > 0 && i < rings) || j == 0) {
                const double theta = std::numbers::pi * i / rings, phi = 2 * std::numbers::pi * j / segments;
                mesh.positions.push_back(
                    {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
            }
    const auto at = [&](int i, int j) {
        return i == 0       ? 0u
               : i == rings ? unsigned(mesh.positions.size() - 1)
                            : unsigned(1 + (i - 1) * segments + j % segments);
    };
    for (int i = 0; i < rings; i++)
        for (int j = 0; j < segments; j++) {
            if (i > 0)
                mesh.triangles.push_back(
                    {{{at(i, j), OPAL_NONE}, {at(i + 1, j), OPAL_NONE}, {at(i, j + 1), OPAL_NONE}}});
            if (i < rings - 1)
                mesh.triangles.push_back(
                    {{{at(i, j + 1), OPAL_NONE}, {at(i + 1, j), OPAL_NONE}, {at(i + 1, j + 1), OPAL_NONE}}});
        }
    return mesh;
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

// From points inside a closed mesh towards its vertices and points of its edges, as floats have them: each must hit.
Finding no_leaks(const std::string &what, const TriangleMesh &mesh, int lanes, const Sources &sources, unsigned seed) {
    const FlatScene flat = flatten(scene_of({diffuse(mesh)}), lanes);
    const std::vector<Slot> triangles = triangles_of(flat);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<HostRay> rays;
    for (size_t i = 0; i < 40000; i++) {
        const Slot &triangle = triangles[random() % triangles.size()];
        const Vec3 a = triangle.p[random() % 3], b = triangle.p[random() % 3]; // often the same: a vertex
        const Vec3 o{0.3 * uniform(random), 0.3 * uniform(random), 0.3 * uniform(random)};
        const Vec3 from = i % 5 == 0 ? Vec3{} : i % 5 == 1 ? Vec3{o.x, 0, 0} : o;
        const double s = i % 2 ? 0.5 : 0.5 + uniform(random) / 2;
        rays.push_back({from, a * s + b * (1 - s) - from, 0, 1e30});
    }
    const Planes found = probe_of(flat, lanes, sources).trace(planes_of_rays(rays));
    size_t leaks = 0;
    for (size_t i = 0; i < rays.size(); i++)
        leaks += found.bits(HIT_SLOT, i) == OPAL_NONE || found.at(HIT_ANY, i) == 0;
    return exact(what + " at " + std::to_string(lanes) + " lanes: " + std::to_string(leaks) + " of 40000 rays leak",
                 leaks == 0);
}

// Inside a cube along its walls, from as far off them as rays start (surface.cl) and as good as in parallel: something
// must be hit, and not beyond the cube.
Finding along_walls(int lanes, const Sources &sources, unsigned seed) {
    const FlatScene flat = flatten(scene_of({diffuse(cube({}, 1))}), lanes);
    double half = 0;
    for (const Slot &slot : triangles_of(flat))
        half = std::max(half, slot.p[0].x);
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
    size_t wrong = 0;
    for (size_t i = 0; i < rays.size(); i++) {
        double exit = INFINITY; // the slopes cannot leave the cube by more than the slack below
        for (const auto &[o, d] :
             {std::pair{rays[i].o.x, rays[i].d.x}, {rays[i].o.y, rays[i].d.y}, {rays[i].o.z, rays[i].d.z}})
            if (std::abs(d) > 1e-5)
                exit = std::min(exit, ((d > 0 ? half : -half) - o) / d);
        wrong += found.bits(HIT_SLOT, i) == OPAL_NONE || found.at(HIT_ANY, i) == 0 ||
                 !(found.at(HIT_T, i) <= exit * (1 + doubt) + doubt);
    }
    return exact("a cube at " + std::to_string(lanes) + " lanes: " + std::to_string(wrong) +
                     " of 40000 rays along its walls end nowhere, or outside",
                 wrong == 0);
}

} // namespace

Findings check_tree(const Sources &sources, unsigned seed) {
    Findings findings = compare_all("1500 triangles", soup(1500, 0.15, seed), tested_lanes(), sources, seed + 1);
    const Findings large =
        compare_all("60 large triangles", soup(60, 1, seed + 2), {device().info.native_lanes}, sources, seed + 3);
    findings.insert(findings.end(), large.begin(), large.end());
    return findings;
}

Findings check_tiny(const Sources &sources, unsigned seed) {
    const SceneDescription triangles = soup(30, 0.8, seed), pairs = quadrilaterals(20, 0.8, seed + 2);
    const FlatScene listed = flatten(pairs, 4);
    Findings findings = {exact("30 triangles need no tree", !flatten(triangles, 4).features[FEATURE_tree]),
                         exact("nor do 20 quadrilaterals, most of them plane as floats have them",
                               !listed.features[FEATURE_tree] && listed.faces.size() < 30)};
    for (const Findings &more : {compare_all("30 triangles", triangles, {4, 16}, sources, seed + 1),
                                 compare_all("20 quadrilaterals", pairs, {4, 16}, sources, seed + 3)})
        findings.insert(findings.end(), more.begin(), more.end());
    return findings;
}

Findings check_watertight(const Sources &sources, unsigned seed) {
    const TriangleMesh slats = turned(drum(1, 200));
    Findings findings = {exact("slats are in the tree in parts",
                               triangles_of(flatten(scene_of({diffuse(slats)}), 4)).size() > slats.triangles.size())};
    for (int lanes : tested_lanes())
        for (const auto &[what, mesh] : {std::pair{"a ball", ball(20, 31)},
                                         {"a cube", cube({}, 1)},
                                         {"a crystal", ball(3, 7)},
                                         {"a drum", drum(30, 24)},
                                         {"slats", slats}})
            findings.push_back(no_leaks(what, mesh, lanes, sources, seed));
    for (int lanes : tested_lanes())
        findings.push_back(along_walls(lanes, sources, seed));
    return findings;
}

} // namespace opal::test
