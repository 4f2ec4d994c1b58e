// Closest and any hit against brute force in double, and rays aimed at the edges and vertices of closed surfaces.
#include "trust/kernel_probe.h"
#include "trust/selftest.h"

#include <cmath>
#include <numbers>
#include <random>

namespace opal {

namespace {

using Corners = std::array<Vec3, 3>;

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

SceneDescription triangle_soup(unsigned count, std::mt19937 &random) {
    std::uniform_real_distribution<double> place(-1, 1), offset(-0.4, 0.4);
    std::vector<Vec3> positions;
    std::vector<std::array<unsigned, 3>> triangles;
    for (unsigned i = 0; i < count; i++) {
        const Vec3 p = {place(random), place(random), place(random)};
        for (int corner = 0; corner < 3; corner++)
            positions.push_back(p + Vec3{offset(random), offset(random), offset(random)});
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return scene_of(positions, triangles);
}

// A sphere of rows x 2 rows quadrilaterals, two triangles each; rows = 2 has few enough triangles for no tree.
SceneDescription closed_sphere(unsigned rows) {
    std::vector<Vec3> positions;
    std::vector<std::array<unsigned, 3>> triangles;
    const unsigned columns = 2 * rows;
    for (unsigned row = 0; row <= rows; row++)
        for (unsigned column = 0; column < columns; column++)
            positions.push_back(stats::spherical_direction(std::cos(std::numbers::pi * row / rows), std::numbers::pi * column / rows));
    for (unsigned row = 0; row < rows; row++)
        for (unsigned column = 0; column < columns; column++) {
            const unsigned a = row * columns + column, b = row * columns + (column + 1) % columns, c = a + columns, d = b + columns;
            if (row > 0)
                triangles.push_back({row == 0 ? 0 : a, b, c});
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
                corners[size_t(c)] = {block.vertex[c][0][slot % 8], block.vertex[c][1][slot % 8], block.vertex[c][2][slot % 8]};
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

// Does a ray hit a triangle: surely, surely not, or too near an edge, an end or edge-on to tell for single precision?
enum class Truth { no, unclear, yes };
struct Answer {
    Truth truth = Truth::no;
    double t = 0;
};
Answer intersect(const Corners &p, Vec3 o, Vec3 d, double tmax) { // Moeller and Trumbore 1997
    const Vec3 e1 = p[1] - p[0], e2 = p[2] - p[0], h = cross(d, e2), s = o - p[0], q = cross(s, e1);
    const double determinant = dot(e1, h), size = length(cross(e1, e2)) * length(d);
    if (std::abs(determinant) < 1e-3 * size)
        return {Truth::unclear, 0};
    const double u = dot(s, h) / determinant, v = dot(d, q) / determinant, t = dot(e2, q) / determinant;
    const double inside = std::min({u, v, 1 - u - v, t, tmax - t});
    return {inside > 1e-3 ? Truth::yes : inside < -1e-3 ? Truth::no : Truth::unclear, t};
}

// Rays whose answer is surely wrong.
double wrong_hits(KernelProbe &probe, size_t count, std::mt19937 &random) {
    std::uniform_real_distribution<double> place(-1.2, 1.2), axis(-1, 1), reach(0.1, 2);
    Planes rays(RAY_PLANES, count);
    for (size_t i = 0; i < count; i++)
        set_ray(rays, i, {place(random), place(random), place(random)}, {axis(random), axis(random), axis(random)}, reach(random));
    const Planes hits = probe.trace(rays);
    std::vector<uint> slots;
    const std::vector<Corners> triangles = corners_of(probe.scene(), slots);
    double wrong = 0;
    for (size_t i = 0; i < count; i++) {
        const Vec3 o = rays.vec3(RAY_O_X, i), d = rays.vec3(RAY_D_X, i);
        const uint slot = hits.bits(HIT_SLOT, i);
        const double t = hits.at(HIT_T, i), tmax = rays.at(RAY_TMAX, i);
        bool any_surely = false, any_maybe = false, good = slot == OPAL_NONE;
        double nearest = INFINITY;
        for (size_t k = 0; k < triangles.size(); k++) {
            const Answer answer = intersect(triangles[k], o, d, tmax);
            any_surely = any_surely || answer.truth == Truth::yes;
            any_maybe = any_maybe || answer.truth != Truth::no;
            if (answer.truth == Truth::yes)
                nearest = std::min(nearest, answer.t);
            if (slots[k] == slot)
                good = answer.truth == Truth::unclear || (answer.truth == Truth::yes && std::abs(answer.t - t) < 1e-4);
        }
        good = good && (slot != OPAL_NONE ? t < nearest + 1e-4 : !any_surely);
        const bool blocked = hits.at(HIT_ANY, i) != 0;
        wrong += !good || (blocked ? !any_maybe : any_surely);
    }
    return wrong;
}

// Rays from inside a closed surface, aimed at its vertices and at points of its edges, that find a way out.
double leaks(KernelProbe &probe, std::mt19937 &random) {
    std::uniform_real_distribution<double> place(-0.4, 0.4), along(0, 1);
    std::vector<uint> slots;
    std::vector<Vec3> targets;
    for (const Corners &p : corners_of(probe.scene(), slots))
        for (size_t c = 0; c < 3; c++) {
            const Vec3 edge = p[(c + 1) % 3] - p[c];
            for (const double s : {0.0, 0.5, along(random), along(random)})
                targets.push_back(p[c] + edge * s);
        }
    const size_t copies = std::max<size_t>(1, 20000 / targets.size());
    Planes rays(RAY_PLANES, copies * targets.size());
    for (size_t i = 0; i < rays.count; i++) {
        const Vec3 o = {float(place(random)), float(place(random)), float(place(random))};
        set_ray(rays, i, o, targets[i % targets.size()] - o, 1e30);
    }
    const Planes hits = probe.trace(rays);
    double lost = 0;
    for (size_t i = 0; i < hits.count; i++)
        lost += hits.bits(HIT_SLOT, i) == OPAL_NONE || hits.at(HIT_ANY, i) == 0;
    return lost;
}

} // namespace

Findings check_rays(const Device &device, const SelftestOptions &options) {
    std::mt19937 random(options.seed + 5);
    const size_t rays = options.full ? 50000 : 4000;
    const auto probe_of = [&](SceneDescription scene, bool specialise) {
        scene.strategy.specialise = specialise;
        FlatScene flat = flatten(scene, options.build.lanes);
        if (specialise) { // one program for all scenes without a tree
            const bool tree = flat.features["tree"];
            flat.features = scene_of_bsdfs({}).features;
            for (Feature &feature : flat.features.list)
                feature.on = feature.name == "tree" ? tree : feature.on && !feature.name.starts_with("bsdf_");
        }
        return KernelProbe(device, flat, options.build, *options.sources);
    };
    KernelProbe soup = probe_of(triangle_soup(300, random), false), sphere = probe_of(closed_sphere(16), false);
    Findings findings = {at_most("tree: hits unlike brute force", wrong_hits(soup, rays, random), 0),
                         at_most("tree: rays lost at edges and vertices", leaks(sphere, random), 0)};
    KernelProbe few = probe_of(triangle_soup(20, random), true), small = probe_of(closed_sphere(3), true);
    if (!few.scene().features["tree"]) {
        findings.push_back(at_most("no tree: hits unlike brute force", wrong_hits(few, rays, random), 0));
        findings.push_back(at_most("no tree: rays lost at edges and vertices", leaks(small, random), 0));
    }
    return findings;
}

} // namespace opal
