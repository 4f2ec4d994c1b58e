// dispatch: directions to emitters, their radiance and density, by the kind of each lane's emitter.
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "emitters/*.cl"
#include "emitters/list.h"
#include "scene.cl"
#include "shared/types.h"
#include "surface.cl"
#include "textures/dispatch.cl"
#include "textures/interface.cl"

// The kind, where the kernel has several; else nobody asks.
static uints emitter_kind(const Scene *scene, uints id) {
    if (EMITTER_KINDS < 2) return (uints)(0);
    return GATHER(uints, scene->emitters, id, .kind);
}

// The active lanes whose emitter is of that kind; kinds: how many there may be.
static mask emitter_lanes(uints kind, uint wanted, int kinds, mask active) {
    return kinds == 1 ? active : active & to_mask(kind == wanted);
}

// A direction from `from` to the emitters `id`, by random numbers u in [0, 1) and random words `bits`.
static LightSample emitter_sample(const Scene *scene, uints id, ReferencePoint from, v2 u, u2 bits, mask active) {
    LightSample sample = no_light_sample();
    v3 color = GATHER_V3(scene->emitters, id, .u.color);
    uints kind = emitter_kind(scene, id);
#define SAMPLE_EMITTER(name, traits) \
    if (OPAL_HAS_emitter_##name) { \
        mask m = emitter_lanes(kind, EMITTER_##name, EMITTER_KINDS, active); \
        if (ANY(m)) { \
            LightSample s = emitter_##name##_sample(scene, id, color, from, u, bits); \
            s.active = s.active & m; \
            s.discrete = ((traits) & OPAL_DELTA) != 0 ? ALL_LANES : NO_LANES; \
            s.infinite = ((traits) & OPAL_INFINITE) != 0 ? ALL_LANES : NO_LANES; \
            if (EMITTER_KINDS == 1) return s; \
            sample = light_sample_pick(m, s, sample); \
        } \
    }
    OPAL_EMITTERS(SAMPLE_EMITTER)
    return sample;
}

// Radiance of the emitters `id`, W / (m^2 sr), that rays of direction d find: where they met the surface s, or where
// they left the scene. 0 in lanes that are not active.
static v3 emitter_radiance(const Scene *scene, uints id, v3 d, const Surface *s, mask active) {
    v3 radiance = v3_all((real)(0)), color = GATHER_V3(scene->emitters, id, .u.color);
    uints kind = emitter_kind(scene, id);
    if (OPAL_HAS_light_textures && OPAL_HAS_uv)
        color = v3_mul(color, texture_color(scene, GATHER(uints, scene->emitters, id, .texture), texture_point_of(s),
                                            active));
#define RADIANCE_OF_EMITTER(name, traits) \
    if (OPAL_HAS_emitter_##name && OPAL_CAN_BE_MET(traits)) { \
        mask m = emitter_lanes(kind, EMITTER_##name, MET_KINDS, active); \
        if (ANY(m)) radiance = v3_pick(m, emitter_##name##_radiance(scene, id, color, d, s), radiance); \
    }
    OPAL_EMITTERS(RADIANCE_OF_EMITTER)
    return radiance;
}

// Density, solid angle measure, with which light sampling at `from` draws the direction d that met s, or that left the
// scene, given the emitter. 0 in lanes that are not active.
static real emitter_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s, mask active) {
    real pdf = 0;
    uints kind = emitter_kind(scene, id);
#define PDF_OF_EMITTER(name, traits) \
    if (OPAL_HAS_emitter_##name && OPAL_CAN_BE_MET(traits)) { \
        mask m = emitter_lanes(kind, EMITTER_##name, MET_KINDS, active); \
        if (ANY(m)) pdf = m ? emitter_##name##_pdf(scene, id, from, d, s) : pdf; \
    }
    OPAL_EMITTERS(PDF_OF_EMITTER)
    return pdf;
}

// The emitters that rays meet: that of the surface s, on a side that emits, where they hit one; else the environment.
// Sets *met to the active lanes that meet one; the others' ids are valid.
static uints emitter_met(const Scene *scene, const Surface *s, mask hit, mask active, mask *met) {
    mask on_light = active & hit & to_mask(s->emitter != OPAL_NONE);
    mask both_sides = emits_on_both_sides(scene, uints_pick(on_light, s->emitter, (uints)(0)));
    *met = on_light & ((s->wi.z > 0) | both_sides);
    uints id = s->emitter;
    if (ENVIRONMENT_KINDS > 0) {
        uints environment = (uints)(scene->settings->environment);
        mask escaped = active & !hit & to_mask(environment != OPAL_NONE);
        *met = *met | escaped;
        id = uints_pick(escaped, environment, id);
    }
    return OPAL_HAS_many_emitters ? uints_pick(*met, id, (uints)(0)) : (uints)(0);
}

// The shadow ray from the surface s to a light.
static Ray shadow_ray(const Surface *s, LightSample light) {
    v3 start = leave_surface(s, light.d), d = v3_sub(light.end, start);
    Ray ray = {start, d, (real)(0), (real)(1)}; // 1: the light's own surface
    if (INFINITE_KINDS > 0) {
        ray.d = v3_pick(light.infinite, light.d, d);
        ray.tmax = light.infinite ? (real)(FAR) : ray.tmax;
    }
    return ray;
}
