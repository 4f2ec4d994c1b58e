// path: path tracing (Kajiya 1986) with BSDF sampling, next-event estimation or both with MIS (--lighting), and Russian
// roulette.
//   nee, mis, rr, rr_prob of path_tracer_recursive; path_mats, path_ems, path_mis name the three kinds of lighting
#include "bsdfs/dispatch.cl"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "surface.cl"

static mask path_step(const Scene *scene, Path *path, Hit hit, mask active) {
    active = active & is_hit(hit);
    if (!ANY(active)) return active;
    Surface s = surface_at(scene, path->ray, hit, active);

    // Light that the ray hits
    add_radiance(scene, path, v3_mul(path->throughput, emitted(scene, path, s, active)));
    active = active & to_mask(path->depth < scene->settings->max_depth);
    if (!ANY(active)) return active;

    // Light that is sampled
    bsdf_open(scene, &s, active);
    mask by_light = CHOSEN(scene, lighting, bsdf) ? NO_LANES : active & !bsdf_is_discrete(scene, s.bsdf);
    LightSample light = sample_light(scene, path, s, by_light);

    // The next segment
    real u = path_draw(scene, path, DIM_LOBE).y;
    active = scatter(scene, path, s, active);
    active = roulette(scene, path, active, u);

    add_radiance(scene, path, visible_light(scene, light));
    return active;
}
