// Closest and any hit against brute force in double, and rays aimed at the edges and vertices of closed surfaces.
#include "selftest/selftest.h"
#include "selftest/watertight.h"

#include <cmath>
#include <numbers>
#include <random>

namespace opal {

namespace {

using edges::Corners;
using edges::corners_of;
using edges::set_ray;

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
    return edges::scene_of(positions, triangles);
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
        set_ray(rays, i, {place(random), place(random), place(random)}, {axis(random), axis(random), axis(random)},
                reach(random));
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

} // namespace

Findings check_rays(const Device &device, const SelftestOptions &options) {
    std::mt19937 random(options.seed + 5);
    const size_t rays = options.full ? 50000 : 4000;
    const auto probe_of = [&](SceneDescription scene, bool specialise) {
        scene.strategy.specialise = specialise;
        FlatScene flat = flatten(scene, options.build.lanes);
        if (specialise) { // one program for all scenes without a tree
            const bool tree = flat.features[FEATURE_tree];
            flat.features = scene_of_bsdfs({}).features;
            flat.features.list[FEATURE_tree].on = tree;
#define OPAL_WITHOUT_BSDF(name) flat.features.list[FEATURE_bsdf_##name].on = false;
            OPAL_BSDFS(OPAL_WITHOUT_BSDF)
#undef OPAL_WITHOUT_BSDF
        }
        return KernelProbe(device, flat, options.build, *options.sources);
    };
    KernelProbe soup = probe_of(triangle_soup(300, random), false), sphere = probe_of(edges::closed_sphere(16), false);
    Findings findings = {
        at_most("tree: hits unlike brute force", wrong_hits(soup, rays, random), 0),
        at_most("tree: rays lost at edges and vertices", double(edges::lost_rays(sphere, 20000, random)), 0)};
    KernelProbe few = probe_of(triangle_soup(20, random), true), small = probe_of(edges::closed_sphere(3), true);
    if (!few.scene().features[FEATURE_tree]) {
        findings.push_back(at_most("no tree: hits unlike brute force", wrong_hits(few, rays, random), 0));
        findings.push_back(
            at_most("no tree: rays lost at edges and vertices", double(edges::lost_rays(small, 20000, random)), 0));
    }
    return findings;
}

} // namespace opal
