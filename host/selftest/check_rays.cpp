// Closest and any hit against brute force in double, and rays aimed at the edges and vertices of closed surfaces.
#include "selftest/selftest.h"
#include "selftest/watertight.h"

namespace opal {

namespace {

Finding check_hits(const std::string &what, KernelProbe &probe, size_t rays, unsigned seed) {
    const HitErrors errors = errors_of_hits(probe, random_rays(rays, seed));
    return none_wrong(what + ": hits unlike brute force", double(errors.closest + errors.any + errors.weights));
}

Finding check_edges(const std::string &what, KernelProbe &probe, unsigned seed) {
    std::mt19937 random(seed);
    return none_wrong(what + ": rays lost at edges and vertices", double(edges::lost_rays(probe, 20000, random)));
}

} // namespace

Findings run_rays(const Device &device, const SelftestOptions &options) {
    const unsigned seed = options.seed + 5;
    const size_t rays = options.full ? 50000 : 4000;
    const auto probe_of = [&](SceneDescription scene, bool specialise) {
        scene.strategy.specialise = specialise ? Specialise::on : Specialise::off;
        FlatScene flat = flatten(scene, options.build.lanes, specialise);
        if (specialise) { // one program for all scenes without a tree
            const bool tree = flat.features[FEATURE_tree], list = flat.features[FEATURE_face_list];
            flat.features = scene_of_bsdfs({}).features;
            flat.features.list[FEATURE_tree].on = tree;
            flat.features.list[FEATURE_face_list].on = list;
#define OPAL_WITHOUT_BSDF(name, traits) flat.features.list[FEATURE_bsdf_##name].on = false;
            OPAL_ALL_BSDFS(OPAL_WITHOUT_BSDF)
#undef OPAL_WITHOUT_BSDF
        }
        return KernelProbe(device, flat, options.build, *options.sources);
    };
    KernelProbe soup = probe_of(triangle_soup(300, 0.4, seed), false),
                sphere = probe_of(scene_of_mesh(edges::closed_sphere(16)), false);
    Findings findings = {check_hits("tree", soup, rays, seed + 1), check_edges("tree", sphere, seed + 2)};
    KernelProbe balls = probe_of(sphere_soup(300, 1e-3, 0.4, seed + 6), false);
    findings.push_back(check_hits("spheres", balls, rays, seed + 7));
    KernelProbe few = probe_of(triangle_soup(20, 0.4, seed + 3), true),
                small = probe_of(scene_of_mesh(edges::closed_sphere(3)), true);
    if (!few.scene().features[FEATURE_tree]) {
        findings.push_back(check_hits("no tree", few, rays, seed + 4));
        findings.push_back(check_edges("no tree", small, seed + 5));
    }
    return findings;
}

} // namespace opal
