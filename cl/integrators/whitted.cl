// whitted: emitted light plus one bounce of direct light by emitter sampling; specular surfaces are followed with
// probability 0.95 (Nori's assignment 4; Whitted 1980).
#include "bsdfs/dispatch.cl"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/dispatch.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "surface.cl"

#define WHITTED_SURVIVAL R(0.95)

static mask whitted_step(const Scene *scene, Path *path, Hit hit, mask active) {
    mask on_surface = active & is_hit(hit);
    if (ENVIRONMENT_KINDS == 0 && !ANY(on_surface)) return on_surface;
    Surface s = surface_met(scene, path, hit, on_surface);
    v3 met = light_met(scene, path, &s, on_surface, active);
    path->radiance = v3_add(path->radiance, v3_mul(path->throughput, met));
    active = on_surface & to_mask(path->depth < scene->settings->max_depth);
    bsdf_open(scene, &s, active);
    mask specular = active & bsdf_is_discrete(scene, s.bsdf);
    v2 u = path_draw(scene, path, DIM_LOBE);
    Choice survives = choose((real)(WHITTED_SURVIVAL), u.y);
    path->throughput = v3_scale(path->throughput, specular ? 1 / survives.probability : (real)(1));
    DirectLight direct;
    mask by_bsdf = MIXED_BSDFS ? active : specular;
    mask followed = interact(scene, path, &s, active & !specular, by_bsdf, u.x, &direct);
    if (MIXED_BSDFS) { // a BSDF that is not wholly discrete may have drawn its mirror
        path->throughput = v3_scale(path->throughput, specular ? (real)(1) : 1 / survives.probability);
        followed = followed & path->specular;
    }
    path->radiance = v3_add(path->radiance, visible_light(scene, direct));
    return followed & survives.first;
}
