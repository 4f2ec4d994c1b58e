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
#include "shapes/dispatch.cl"
#include "shared/counters.h"
#include "shared/types.h"
#include "surface.cl"
#include "trace/trace.cl"

typedef struct {
    Ray ray;
    v3 throughput, radiance;
    v3 lost;         // what rounding took from radiance (add_radiance)
    real pdf;        // density with which ray.d was drawn, solid angle measure
    ReferencePoint from; // where it was drawn, for light sampling's density there
    real eta;        // product of the indices passed: throughput * eta^2 is free of refraction's scaling
    mask specular;   // camera ray or delta lobe: emission it hits counts in full
    mask straight;   // of kernels that hide emitters: the camera's ray, which may have passed through surfaces
    Ray first_ray;   // of kernels with sample counts: the camera's ray ...
    Hit first_hit;   // ... and where it hit
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

// What the camera's rays hit where emitters are hidden: a ray that hits an emitter goes on behind it, as if it were not
// there. The path's ray begins there then, and the path has no segment more.
static Hit pass_hidden_emitters(const Scene *scene, Path *path, Hit hit, mask active) {
    if (!OPAL_HAS_hidden_emitters) return hit;
    mask from_camera = active & to_mask(path->depth == 1u), passing = from_camera & is_hit(hit);
    path->straight = from_camera | path->straight;
    while (ANY(passing)) {
        Surface s = surface_at(scene, path->ray, hit, passing);
        passing = passing & to_mask(s.emitter != OPAL_NONE);
        if (!ANY(passing)) break;
        path->ray.o = v3_pick(passing, leave_surface(&s, path->ray.d), path->ray.o);
        path->ray.tmin = passing ? (real)(0) : path->ray.tmin;
        path->ray.tmax = passing ? path->ray.tmax - s.t : path->ray.tmax;
        hit = hit_pick(passing, closest_hit(scene, path->ray, passing, NO_LANES), hit);
        add_count(scene, COUNTER_rays, count_lanes(passing));
        passing = passing & is_hit(hit);
    }
    return hit;
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

// MIS weight of a sample (Veach 1997, eq. 9.8 and 9.10); ratio: the other technique's density over its own, each times
// its number of samples. A ratio survives densities that are 0 or overflow.
static real mis_weight(const Scene *scene, real ratio) {
    return 1 / (1 + (CHOSEN(scene, mis, power) ? ratio * ratio : ratio));
}

// Light samples for each BSDF sample of a surface.
static real light_samples_per_bsdf_sample(const Scene *scene) {
    if (!OPAL_HAS_sample_counts) return (real)(1);
    return (real)((real1)scene->settings->emitter_samples / (real1)scene->settings->bsdf_samples);
}

// The surface that each lane of on_surface hit.
static Surface surface_met(const Scene *scene, const Path *path, Hit hit, mask on_surface) {
    if ((ENVIRONMENT_KINDS > 0 || OPAL_HAS_sample_counts) && !ANY(on_surface)) return no_surface();
    return surface_at(scene, path->ray, hit, on_surface);
}

// Radiance of the lights that the path's rays meet, where they hit the surface s or, in lanes without a hit, leave the
// scene; times the MIS weight of meeting it by a BSDF sample. 0 in lanes that are not active.
static CALLED v3 light_met(const Scene *scene, const Path *path, const Surface *s, mask hit, mask active) {
    v3 none = v3_all((real)(0));
    if (MET_KINDS == 0) return none;
    mask met;
    uints id = emitter_met(scene, s, hit, active, &met);
    if (CHOSEN(scene, lighting, emitter)) met = met & path->specular;
    if (OPAL_HAS_hidden_emitters) met = met & !(path->straight & !hit);
    if (!ANY(met)) return none;
    v3 radiance = emitter_radiance(scene, id, path->ray.d, s, met);
    if (CHOSEN(scene, lighting, mis)) {
        real light_pdf = emitter_pdf(scene, id, path->from, path->ray.d, s, met);
        real ratio = light_pdf * emitter_probability(scene, id, path->from) / path->pdf;
        if (OPAL_HAS_sample_counts) ratio = ratio * light_samples_per_bsdf_sample(scene);
        radiance = v3_scale(radiance, path->specular ? (real)(1) : mis_weight(scene, ratio));
    }
    return v3_pick(met, radiance, none);
}

// The lanes of `active` whose BSDF draws the next segment: not those in which it would be the last one and meet no
// light that counts.
static mask next_segment_counts(const Scene *scene, const Path *path, const Surface *s, mask active) {
    mask last = !to_mask(path->depth + 1u < scene->settings->max_depth);
    if (MET_KINDS == 0) return active & !last;
    if (!CHOSEN(scene, lighting, emitter)) return active;
    if (MIXED_BSDFS) return active;
    return active & (!last | bsdf_is_discrete(scene, s->bsdf));
}

// Samples one direction to one emitter as the light of surface s, before its BSDF is asked. Sets *wo to the direction
// in the surface's frame. inverse_pdf includes the choice of the emitter.
static LightSample sample_light(const Scene *scene, const Path *path, const Surface *s, mask active, v3 *wo) {
    *wo = s->wi;
    if (EMITTER_KINDS == 0 || !ANY(active)) return no_light_sample();
    ReferencePoint from = reference_point(s);
    EmitterChoice choice = emitter_choose(scene, from, path_draw_bits(scene, path, DIM_EMITTER));
    LightSample light = emitter_sample(scene, choice.id, from, path_draw(scene, path, DIM_LIGHT),
                                       path_draw_bits(scene, path, DIM_TRIANGLE), active);
    *wo = to_local(s->frame, light.d);
    light.inverse_pdf = light.inverse_pdf / choice.probability;
    light.active = light.active & bsdf_is_lit_from(scene, s->bsdf, *wo);
    return light;
}

// Direct light by one light sample, until visible_light tests the shadow ray.
typedef struct {
    v3 radiance;     // throughput and MIS weight included
    Ray shadow;
    mask active;     // the lanes that have such a sample
} DirectLight;

// Completes a light sample by what the BSDF answers for its direction.
static DirectLight direct_light(const Scene *scene, const Path *path, const Surface *s, LightSample light,
                                BsdfResponse bsdf) {
    real inverse_pdf = light.inverse_pdf;
    if (MET_KINDS > 0 && CHOSEN(scene, lighting, mis)) {
        real ratio = bsdf.pdf * inverse_pdf;
        if (OPAL_HAS_sample_counts) ratio = ratio / light_samples_per_bsdf_sample(scene);
        real weight = mis_weight(scene, light.discrete ? (real)(0) : ratio);
        inverse_pdf = weight * inverse_pdf;
    }
    v3 light_in = v3_scale(v3_mul(bsdf.f, light.radiance), bsdf.cosine * inverse_pdf);
    // Light that is not finite must reach the film, where it is counted.
    mask active = light.active & ((v3_largest(light_in) > 0) | !is_finite(light_in));
    DirectLight direct = {v3_mul(path->throughput, light_in), shadow_ray(s, light), active};
    return direct;
}

// The radiance of direct light where nothing blocks its shadow ray, else 0.
static v3 visible_light(const Scene *scene, DirectLight light) {
    v3 none = v3_all((real)(0));
    if (EMITTER_KINDS == 0 || !ANY(light.active)) return none;
    mask blocked = any_hit_to_light(scene, light.shadow, light.active);
    if (OPAL_REPEAT_traversal) {
        Ray again = same_ray(light.shadow, blocked | (light.shadow.o.x < FAR));
        blocked = any_hit_to_light(scene, again, light.active);
    }
    add_count(scene, COUNTER_shadow_rays, count_lanes(light.active));
    return v3_pick(light.active & !blocked, light.radiance, none);
}

// The least normal float: a path with less throughput ends. The least denormal times 0.9 rounds to itself, so that
// paths would go on for ever.
#define THROUGHPUT_LEAST R(1.1754944e-38)

// Sets the path's next segment to a sample of the BSDF. Returns the active lanes whose path still carries something.
static mask scatter(const Scene *scene, Path *path, const Surface *s, BsdfSample sample, mask active) {
    mask broken = active & !is_finite(sample.weight);
    if (ANY(broken)) { // the path ends, and the film counts it
        path->radiance = v3_pick(broken, sample.weight, path->radiance);
        active = active & !broken;
    }
    active = active & (v3_largest(sample.weight) > 0);
    v3 d = to_world(s->frame, sample.wo);
    path->ray.o = leave_surface(s, d);
    path->ray.d = d;
    path->ray.tmin = 0;
    path->ray.tmax = FAR;
    path->throughput = v3_mul(path->throughput, sample.weight);
    if (TRANSMITTING_BSDF_KINDS > 0) { // radiance is scaled where light enters another medium (Veach 1997, section 5.2)
        path->throughput = v3_scale(path->throughput, 1 / square(sample.eta));
        path->eta = path->eta * sample.eta;
    }
    path->specular = sample.discrete;
    if (OPAL_HAS_hidden_emitters) path->straight = path->straight & sample.passes;
    if (CHOSEN(scene, lighting, mis)) {
        path->pdf = sample.pdf;
        path->from = reference_point(s);
    }
    path->depth = path->depth + 1u;
    return active & (v3_largest(path->throughput) >= THROUGHPUT_LEAST);
}

// What happens to the path at surface s: in the lanes of by_light a direction to a light is sampled, in those of
// by_bsdf the next segment. The BSDF is asked once for both; lobe: the first number of DIM_LOBE. Sets *direct, whose
// visibility is tested later, by visible_light, so that a processor works at this and at the next segment at the same
// time. Returns the lanes of by_bsdf whose path still carries something.
static CALLED mask interact(const Scene *scene, Path *path, const Surface *s, mask by_light, mask by_bsdf, real lobe,
                     DirectLight *direct) {
    v3 wo;
    LightSample light = sample_light(scene, path, s, by_light, &wo);
    BsdfNumbers numbers = {path_draw(scene, path, DIM_BSDF), lobe, (real)(0), (real)(0)};
    if (OPAL_HAS_bsdf_mask || OPAL_HAS_bsdf_blendbsdf) {
        v2 choices = path_draw(scene, path, DIM_MET);
        numbers.met = choices.x;
        numbers.leaf = choices.y;
    }
    BsdfResponse bsdf = bsdf_respond(scene, s, wo, light.active, numbers, by_bsdf);
    *direct = direct_light(scene, path, s, light, bsdf);
    return scatter(scene, path, s, bsdf.sample, by_bsdf);
}

// Russian roulette: ends paths at random and divides the others' throughput by their probability to survive. Returns
// the active lanes that survive. u: second number of DIM_LOBE, whose first chose the lobe in scatter. rr_max is below 1
// by default (--rr-max), because total reflection can hold a path in glass for ever, and no lower, because the variance
// of a furnace of albedo a is finite only for a^2 < survival.
static mask roulette(const Scene *scene, Path *path, mask active, real u) {
    if (CHOSEN(scene, rr, off)) return active;
    real survival = scene->settings->rr_prob;
    if (!CHOSEN(scene, rr, fixed)) {
        survival = v3_largest(path->throughput);
        if (CHOSEN(scene, rr, throughput_eta)) survival = survival * square(path->eta);
        survival = drawn_probability(real_min(survival, (real)(scene->settings->rr_max)));
    }
    mask plays = active & to_mask(path->depth > scene->settings->rr_depth);
    path->throughput = v3_scale(path->throughput, plays ? 1 / survival : (real)(1));
    return active & (!plays | (u < survival));
}
