// steps: what integrators share: a path's state, light that is hit, light that is sampled, the next direction,
// roulette.
#include "bsdfs/dispatch.cl"
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "emitters/choice.cl"
#include "emitters/dispatch.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "shared/counters.h"
#include "shared/types.h"
#include "surface.cl"
#include "trace/trace.cl"

typedef struct {
    Ray ray;
    v3 throughput, radiance;
    v3 lost;         // what rounding took from radiance (add_radiance)
    real pdf;        // density with which ray.d was drawn, solid angle measure
    real eta;        // product of the indices passed: throughput * eta^2 is free of refraction's scaling
    mask specular;   // camera ray or delta lobe: emission it hits counts in full
    uints depth;     // segments so far, this ray included
    Sampler sampler;
} Path;

// Random numbers and words `dimension` of the path's present segment.
static v2 path_draw(const Scene *scene, const Path *path, uint dimension) {
    return draw(scene, path->sampler, segment_dimension(path->depth, dimension));
}
static u2 path_draw_bits(const Scene *scene, const Path *path, uint dimension) {
    return draw_bits(scene, path->sampler, segment_dimension(path->depth, dimension));
}

// Adds light to the path's radiance. Without roulette a path may have thousands of segments, and a plain sum would lose
// 2e-5 of it: what rounding takes is kept for the next addition (Kahan 1965). With roulette noise is far above that,
// and a GPU has no registers to spare.
static void add_radiance(const Scene *scene, Path *path, v3 light) {
    if (!CHOSEN(scene, rr, off)) {
        path->radiance = v3_add(path->radiance, light);
        return;
    }
    v3 term = v3_add(light, path->lost), sum = v3_add(path->radiance, term);
    path->lost = v3_sub(term, v3_sub(sum, path->radiance));
    path->radiance = sum;
}

// MIS weight of a sample (Veach 1997, eq. 9.8 and 9.10); ratio: the other technique's density over its own. A ratio
// survives densities that are 0 or overflow.
static real mis_weight(const Scene *scene, real ratio) {
    return 1 / (1 + (CHOSEN(scene, mis, power) ? ratio * ratio : ratio));
}

// Radiance that the surface emits towards wi, times the MIS weight of hitting it by a BSDF sample; 0 in lanes that are
// not active.
static v3 emitted(const Scene *scene, const Path *path, Surface s, mask active) {
    v3 none = v3_all((real)(0));
    if (EMITTER_KINDS == 0) return none;
    mask active_emitter = active & to_mask(s.emitter != OPAL_NONE) & (s.wi.z > 0);
    if (CHOSEN(scene, lighting, emitter)) active_emitter = active_emitter & path->specular;
    if (!ANY(active_emitter)) return none;
    uints id = OPAL_HAS_many_emitters ? uints_pick(active_emitter, s.emitter, (uints)(0)) : (uints)(0);
    v3 radiance = emitter_radiance(scene, id);
    if (CHOSEN(scene, lighting, mis)) {
        // Distance^2 / cosine turns the light's density from area into solid angle measure.
        real cosine = fabs(v3_dot(s.normal, path->ray.d));
        real area_pdf = emitter_area_pdf(scene, id, s.triangle, active_emitter);
        real ratio = area_pdf * square(s.t) / (cosine * path->pdf);
        radiance = v3_scale(radiance, path->specular ? (real)(1) : mis_weight(scene, ratio));
    }
    return v3_pick(active_emitter, radiance, none);
}

// Direct light by one point on a light, until visible_light tests the shadow ray.
typedef struct {
    v3 radiance;     // throughput and MIS weight included
    Ray shadow;
    mask active;     // the lanes that have such a point
} LightSample;

// Samples one point on one emitter as the light of surface s. Visibility is tested later, by visible_light, so that a
// processor works at this and at scatter at the same time.
static LightSample sample_light(const Scene *scene, const Path *path, Surface s, mask active) {
    LightSample sample;
    sample.radiance = sample.shadow.o = sample.shadow.d = v3_all((real)(0));
    sample.shadow.tmin = 0;
    sample.shadow.tmax = 1; // the light's surface
    sample.active = NO_LANES;
    if (EMITTER_KINDS == 0 || !ANY(active)) return sample;
    uints id = emitter_choose(scene, path_draw_bits(scene, path, DIM_EMITTER));
    EmitterSample light = emitter_sample(scene, id, path_draw(scene, path, DIM_LIGHT),
                                         path_draw_bits(scene, path, DIM_TRIANGLE), active);

    v3 to_light = v3_sub(light.p, s.p);
    real inverse_distance = rsqrt(v3_dot(to_light, to_light));
    v3 wo = to_local(s.frame, v3_scale(to_light, inverse_distance));
    mask front = light.discrete | (v3_dot(light.shading_normal, to_light) < 0);
    active = active & front & bsdf_is_lit_from(scene, s.bsdf, wo) & (inverse_distance < FAR);
    if (!ANY(active)) return sample;

    // 1 / pdf of wo, solid angle measure (of a point light 1 / distance^2): cosine / distance^2 turns the area measure
    // into it.
    real cosine = light.discrete ? (real)(1) : fabs(v3_dot(light.normal, to_light)) * inverse_distance;
    real inverse_pdf = cosine * square(inverse_distance) * light.inverse_pdf / emitter_probability(scene, id);
    BsdfResponse bsdf = bsdf_respond(scene, s, wo, active, v2_of((real)(0), (real)(0)), (real)(0), NO_LANES);
    if (CHOSEN(scene, lighting, mis)) {
        real weight = mis_weight(scene, light.discrete ? (real)(0) : bsdf.pdf * inverse_pdf);
        inverse_pdf = weight * inverse_pdf;
    }
    v3 light_in = v3_scale(v3_mul(bsdf.f, emitter_radiance(scene, id)), wo.z * inverse_pdf);
    // Light that is not finite must reach the film, where it is counted.
    sample.active = active & ((v3_largest(light_in) > 0) | !is_finite(light_in));
    sample.radiance = v3_mul(path->throughput, light_in);
    sample.shadow.o = leave_surface(s, to_light);
    sample.shadow.d = v3_sub(shadow_ray_end(light, to_light), sample.shadow.o);
    return sample;
}

// The radiance of a light sample where nothing blocks its shadow ray, else 0.
static v3 visible_light(const Scene *scene, LightSample sample) {
    v3 none = v3_all((real)(0));
    if (EMITTER_KINDS == 0 || !ANY(sample.active)) return none;
    mask blocked = any_hit_to_light(scene, sample.shadow, sample.active);
    if (OPAL_REPEAT_traversal) {
        Ray again = same_ray(sample.shadow, blocked | (sample.shadow.o.x < FAR));
        blocked = any_hit_to_light(scene, again, sample.active);
    }
    add_count(scene, COUNTER_shadow_rays, count_lanes(sample.active));
    return v3_pick(sample.active & !blocked, sample.radiance, none);
}

// The least normal float: a path with less throughput ends. The least denormal times 0.9 rounds to itself, so that
// paths would go on for ever.
#define THROUGHPUT_LEAST R(1.1754944e-38)

// Draws the path's next segment by the BSDF. Returns the active lanes whose path still carries something.
static mask scatter(const Scene *scene, Path *path, Surface s, mask active) {
    v2 lobe = path_draw(scene, path, DIM_LOBE);
    BsdfSample sample = bsdf_sample(scene, s, path_draw(scene, path, DIM_BSDF), lobe.x, active);
    mask broken = active & !is_finite(sample.weight);
    if (ANY(broken)) { // the path ends, and the film counts it
        path->radiance = v3_pick(broken, sample.weight, path->radiance);
        active = active & !broken;
    }
    active = active & (v3_largest(sample.weight) > 0);
    v3 d = to_world(s.frame, sample.wo);
    path->ray.o = leave_surface(s, d);
    path->ray.d = d;
    path->ray.tmin = 0;
    path->ray.tmax = FAR;
    path->throughput = v3_mul(path->throughput, sample.weight);
    path->eta = path->eta * sample.eta;
    path->specular = sample.discrete;
    if (CHOSEN(scene, lighting, mis)) path->pdf = sample.pdf;
    path->depth = path->depth + 1u;
    return active & (v3_largest(path->throughput) >= THROUGHPUT_LEAST);
}

// The greatest probability to survive. It is below 1, because total reflection can hold a path in glass for ever, and
// no lower, because the variance of a furnace of albedo a is finite only for a^2 < survival.
#define ROULETTE_MOST R(0.9999)

// Russian roulette: ends paths at random and divides the others' throughput by their probability to survive. Returns
// the active lanes that survive. u: second number of DIM_LOBE, whose first chose the lobe in scatter
static mask roulette(const Scene *scene, Path *path, mask active, real u) {
    if (CHOSEN(scene, rr, off)) return active;
    real survival = scene->settings->rr_prob;
    if (!CHOSEN(scene, rr, fixed)) {
        survival = v3_largest(path->throughput);
        if (CHOSEN(scene, rr, throughput_eta)) survival = survival * square(path->eta);
        survival = drawn_probability(real_min(survival, (real)(ROULETTE_MOST)));
    }
    mask plays = active & to_mask(path->depth > scene->settings->rr_depth);
    path->throughput = v3_scale(path->throughput, plays ? 1 / survival : (real)(1));
    return active & (!plays | (u < survival));
}
