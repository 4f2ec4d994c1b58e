// direct_lighting: an emitter that is seen shows its radiance and nothing else; other surfaces show one bounce of
// direct light.
//   surface_sampling   by points on the lights (--lighting emitter), else by BSDF sampling (bsdf)
//   mis_sampling       by one of both with probability 1/2 and the balance heuristic (--lighting mis --mis one-sample);
//                      balance and power take one sample of each
#include "bsdfs/dispatch.cl"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/dispatch.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "shared/types.h"
#include "surface.cl"

static mask direct_lighting_step(const Scene *scene, Path *path, Hit hit, mask active) {
    mask on_surface = active & is_hit(hit);
    if (ENVIRONMENT_KINDS == 0 && !ANY(on_surface)) return on_surface;
    Surface s = surface_met(scene, path, hit, on_surface);
    v3 met = light_met(scene, path, &s, on_surface, active);
    path->radiance = v3_add(path->radiance, v3_mul(path->throughput, met));

    // The first surface gathers direct light, unless it is a light.
    active = on_surface & to_mask(path->depth == 1u) & to_mask(s.emitter == OPAL_NONE) &
             to_mask(path->depth < scene->settings->max_depth);
    if (!ANY(active)) return active;
    bsdf_open(scene, &s, active);
    mask discrete = bsdf_is_discrete(scene, s.bsdf);
    mask by_bsdf = active, by_light = active & !discrete;
    v2 u = path_draw(scene, path, DIM_LOBE);
    if (CHOSEN(scene, lighting, emitter)) by_bsdf = OPAL_HAS_mirror_coats ? active : active & discrete;
    if (CHOSEN(scene, lighting, mis) && CHOSEN(scene, mis, one_sample)) {
        Choice light = choose((real)(R(0.5)), u.y);
        by_bsdf = active & (discrete | !light.first);
        by_light = by_light & light.first;
        path->throughput = v3_scale(path->throughput, discrete ? (real)(1) : 1 / light.probability);
    }
    if (CHOSEN(scene, lighting, bsdf)) by_light = NO_LANES;
    DirectLight direct;
    active = interact(scene, path, &s, by_light, by_bsdf, u.x, &direct);
    if (CHOSEN(scene, lighting, emitter) && OPAL_HAS_mirror_coats) active = active & path->specular;
    path->radiance = v3_add(path->radiance, visible_light(scene, direct));
    return active;
}
