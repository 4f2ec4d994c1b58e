// direct_lighting: an emitter that is seen shows its radiance and nothing else (unless settings->lights_reflect); other
// surfaces show one bounce of direct light.
//   surface_sampling   by points on the lights (--lighting emitter), else by BSDF sampling (bsdf)
//   mis_sampling       by one of both with probability 1/2 and the balance heuristic (--lighting mis --mis one-sample);
//                      balance and power take emitter_samples and bsdf_samples, of each kind 1 by default
#include "bsdfs/dispatch.cl"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/dispatch.cl"
#include "emitters/interface.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "shared/types.h"
#include "surface.cl"

// Several samples of a kind (OPAL_HAS_sample_counts): the first surface takes all light samples at once, and its BSDF
// samples one after the other. Each ray of a BSDF sample is a segment of its own, after which the path goes on at the
// first surface. Sample k, from 0 on, has the random numbers of segment 1 + k.

// Direct light of the surface s by settings->emitter_samples light samples, their mean.
static v3 light_by_samples(const Scene *scene, const Path *path, const Surface *s, mask by_light) {
    v3 sum = v3_all((real)(0));
    if (!ANY(by_light)) return sum;
    Path drawing = *path;
    uint count = scene->settings->emitter_samples;
    for (uint k = 0; k < count; k++) {
        drawing.depth = (uints)(1 + k);
        v3 wo;
        LightSample light = sample_light(scene, &drawing, s, by_light, &wo);
        BsdfResponse bsdf = bsdf_respond(scene, s, wo, light.active, no_numbers(), NO_LANES);
        sum = v3_add(sum, visible_light(scene, direct_light(scene, &drawing, s, light, bsdf)));
    }
    return v3_scale(sum, (real)(1 / (real1)count));
}

// Puts the paths whose BSDF sample was followed back to their first surface, in *s, where further samples are left.
// Keeps the first ray and hit of the others. Returns the paths that are back.
static mask back_to_first_surface(const Scene *scene, Path *path, Hit hit, mask active, Surface *s) {
    mask first = active & to_mask(path->depth == 1u);
    path->first_ray = ray_pick(first, path->ray, path->first_ray);
    path->first_hit = hit_pick(first, hit, path->first_hit);
    mask back = active & !first & to_mask(path->depth <= scene->settings->bsdf_samples);
    if (!ANY(back)) return back;
    path->ray = ray_pick(back, path->first_ray, path->ray);
    path->throughput = v3_pick(back, v3_all((real)(1)), path->throughput);
    path->straight = path->straight | back;
    *s = surface_pick(back, surface_at(scene, path->first_ray, path->first_hit, back), *s);
    return back;
}

static mask direct_lighting_step(const Scene *scene, Path *path, Hit hit, mask active) {
    mask on_surface = active & is_hit(hit);
    if (ENVIRONMENT_KINDS + OPAL_HAS_sample_counts == 0 && !ANY(on_surface)) return on_surface;
    Surface s = surface_met(scene, path, hit, on_surface);
    v3 met = light_met(scene, path, &s, on_surface, active);
    path->radiance = v3_add(path->radiance, v3_mul(path->throughput, met));

    // The first surface gathers direct light, unless it is a light that is to show nothing else.
    mask back = NO_LANES;
    if (OPAL_HAS_sample_counts) back = back_to_first_surface(scene, path, hit, active, &s);
    active = on_surface & to_mask(path->depth == 1u) & to_mask(path->depth < scene->settings->max_depth);
    if (!scene->settings->lights_reflect) active = active & to_mask(s.emitter == OPAL_NONE);
    mask by_bsdf = active | back, by_light = active;
    active = by_bsdf;
    if (!ANY(active)) return active;
    bsdf_open(scene, &s, active);
    mask discrete = bsdf_is_discrete(scene, s.bsdf);
    by_light = by_light & !discrete;
    v2 u = path_draw(scene, path, DIM_LOBE);
    if (CHOSEN(scene, lighting, emitter)) by_bsdf = MIXED_BSDFS ? active : active & discrete;
    if (CHOSEN(scene, lighting, mis) && CHOSEN(scene, mis, one_sample)) {
        Choice light = choose((real)(R(0.5)), u.y);
        by_bsdf = active & (discrete | !light.first);
        by_light = by_light & light.first;
        path->throughput = v3_scale(path->throughput, discrete ? (real)(1) : 1 / light.probability);
    }
    if (CHOSEN(scene, lighting, bsdf)) by_light = NO_LANES;
    if (MET_KINDS == 0) by_bsdf = NO_LANES;
    if (OPAL_HAS_sample_counts) {
        path->radiance = v3_add(path->radiance, light_by_samples(scene, path, &s, by_light));
        by_light = NO_LANES;
        path->throughput = v3_scale(path->throughput, (real)(1 / (real1)scene->settings->bsdf_samples));
    }
    DirectLight direct;
    active = interact(scene, path, &s, by_light, by_bsdf, u.x, &direct);
    if (MIXED_BSDFS && CHOSEN(scene, lighting, emitter)) active = active & path->specular;
    path->radiance = v3_add(path->radiance, visible_light(scene, direct));
    if (OPAL_HAS_sample_counts) { // a sample that carries nothing: its ray is the first one again, and finds nothing
        mask more = by_bsdf & !active & to_mask(path->depth <= scene->settings->bsdf_samples);
        path->ray = ray_pick(more, path->first_ray, path->ray);
        path->throughput = v3_pick(more, v3_all((real)(0)), path->throughput);
        path->specular = path->specular | more; // no MIS weight, as there may be no density
        active = active | more;
    }
    return active;
}
