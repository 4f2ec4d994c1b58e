// path: path tracing (Kajiya 1986) with BSDF sampling, next-event estimation or both with MIS (--lighting), and Russian
// roulette.
//   nee, mis, rr, rr_prob of path_tracer_recursive; path_mats, path_ems, path_mis name the three kinds of lighting
#include "bsdfs/dispatch.cl"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/dispatch.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "surface.cl"

static mask path_step(const Scene *scene, Path *path, Hit hit, mask active) {
    mask on_surface = active & is_hit(hit);
    if (ENVIRONMENT_KINDS == 0 && !ANY(on_surface)) return on_surface;
    Surface s = surface_met(scene, path, hit, on_surface);

    // Light that the ray meets
    add_radiance(scene, path, v3_mul(path->throughput, light_met(scene, path, &s, on_surface, active)));
    active = on_surface & to_mask(path->depth < scene->settings->max_depth);
    if (!ANY(active)) return active;

    // Light that is sampled, and the next segment
    bsdf_open(scene, &s, active);
    mask by_light = CHOSEN(scene, lighting, bsdf) ? NO_LANES : active & !bsdf_is_discrete(scene, s.bsdf);
    v2 u = path_draw(scene, path, DIM_LOBE);
    DirectLight direct;
    active = interact(scene, path, &s, by_light, next_segment_counts(scene, path, &s, active), u.x, &direct);
    active = roulette(scene, path, active, u.y);

    add_radiance(scene, path, visible_light(scene, direct));
    return active;
}
