// dispatch: the BSDF of each lane's material, picked by kind. Each kind that the kernel has is computed for all lanes
// as soon as one active lane needs it.
#include "bsdfs/*.cl"
#include "bsdfs/list.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "scene.cl"
#include "surface.cl"
#include "textures/interface.cl"

#define COUNT_BSDF(name, traits) +OPAL_HAS_bsdf_##name
#define COUNT_TRANSMITTING(name, traits) +(OPAL_HAS_bsdf_##name && ((traits) & OPAL_TRANSMITS) != 0)
#define IS_DISCRETE(traits) (((traits) & OPAL_SMOOTH) == 0)
#define COUNT_DISCRETE(name, traits) +(OPAL_HAS_bsdf_##name && IS_DISCRETE(traits))
#define HAS_BOTH(traits, a, b) (((traits) & ((a) | (b))) == ((a) | (b)))
#define COUNT_MIXED(name, traits) +(OPAL_HAS_bsdf_##name && HAS_BOTH(traits, OPAL_SMOOTH, OPAL_DISCRETE))
#define IS_LIT_FROM_BEHIND(traits) HAS_BOTH(traits, OPAL_SMOOTH, OPAL_TRANSMITS)
#define COUNT_BOTH_SIDES(name, traits) +(OPAL_HAS_bsdf_##name && IS_LIT_FROM_BEHIND(traits))
enum { // of this kernel
    BSDF_KINDS = 0 OPAL_BSDFS(COUNT_BSDF),
    TRANSMITTING_BSDF_KINDS = 0 OPAL_BSDFS(COUNT_TRANSMITTING),
    DISCRETE_BSDF_KINDS = 0 OPAL_BSDFS(COUNT_DISCRETE),
    BOTH_SIDES_BSDF_KINDS = 0 OPAL_BSDFS(COUNT_BOTH_SIDES),
    NESTING_BSDF_KINDS = 0 OPAL_NESTING_BSDFS(COUNT_BSDF),
    // Whether a BSDF may have both a density and single directions.
    MIXED_BSDFS = (OPAL_HAS_mirror_coats + OPAL_HAS_bsdf_mask OPAL_BSDFS(COUNT_MIXED)) != 0
};

// The kind, where the kernel has several; else nobody asks.
static uints bsdf_kind(const Scene *scene, uints at) {
    if (BSDF_KINDS + NESTING_BSDF_KINDS < 2) return (uints)(0);
    return GATHER_WORD(uints, scene->bsdfs, at);
}

// The lanes of that kind, by bsdf_kind.
static mask bsdf_lanes(uints kind, uint wanted) {
    if (BSDF_KINDS == 1) return ALL_LANES;
    return to_mask(kind == wanted);
}

// Sets the surface's BSDF, frame, wi and opacity to those of the BSDF that nested ones lead to. The functions below are
// asked after that.
static void bsdf_open(const Scene *scene, Surface *s, mask active) {
    if (NESTING_BSDF_KINDS == 0) return;
    BsdfOpening o = {s->bsdf, s->wi, s->frame, (real)(1)};
    mask opened;
    do {
        uints kind = bsdf_kind(scene, o.at);
        opened = NO_LANES;
#define OPEN(name, traits) \
        if (OPAL_HAS_bsdf_##name) { \
            mask m = active & to_mask(kind == BSDF_##name); \
            if (ANY(m)) o = bsdf_opening_pick(m, name##_open(name##_at(scene, o.at, texture_point_of(s), m), o), o); \
            opened = opened | m; \
        }
        OPAL_NESTING_BSDFS(OPEN)
    } while (ANY(opened));
    s->bsdf = o.at;
    s->wi = o.wi;
    s->frame = o.frame;
    s->opacity = o.opacity;
}

// What the BSDFs of a surface answer, one a lane.
typedef struct {
    v3 f;              // f(wi, wo) towards a light, without the cosine, 1/sr; 0 for discrete BSDFs
    real pdf;          // the density with which `sample` would draw that wo, solid angle measure; 0 likewise
    BsdfSample sample; // the next direction
} BsdfResponse;

// What a surface answers whose BSDF answers `r` and is met with probability s->opacity. met: a random number
static BsdfResponse masked(const Surface *s, BsdfResponse r, real met, mask sampled) {
    Choice meets = choose(s->opacity, met);
    real drawn = drawn_probability(s->opacity);
    BsdfSample passing = passing_sample(s->wi, (1 - s->opacity) / meets.probability);
    r.f = v3_scale(r.f, s->opacity);
    r.pdf = r.pdf * drawn;
    r.sample.weight = v3_scale(r.sample.weight, meets.first ? s->opacity / drawn : (real)(1));
    r.sample.pdf = r.sample.pdf * drawn;
    r.sample = bsdf_sample_pick(sampled & !meets.first, passing, r.sample);
    return r;
}

// Random numbers in [0, 1) for the sample of a BSDF.
typedef struct {
    v2 u;      // the direction
    real lobe; // which lobe
    real met;  // whether the surface is met; drawn of kernels with masks
} BsdfNumbers;

// Evaluates the surface's BSDFs in direction wo, in the lanes of `evaluated`, and draws a direction by `numbers` in
// those of `sampled`. f, pdf and the weight are 0 in other lanes. Both in one call, because each kind's code is
// compiled, and each material read, once a call.
static BsdfResponse bsdf_respond(const Scene *scene, const Surface *s, v3 wo, mask evaluated, BsdfNumbers numbers,
                                 mask sampled) {
    BsdfResponse r;
    r.f = v3_all((real)(0));
    r.pdf = 0;
    r.sample = bsdf_sample_of(s->wi, v3_all((real)(0)), (real)(0), (real)(1), NO_LANES);
    uints kind = bsdf_kind(scene, s->bsdf);
#define RESPOND(name, traits) \
    if (OPAL_HAS_bsdf_##name) { \
        mask same = bsdf_lanes(kind, BSDF_##name); \
        mask m_evaluated = evaluated & same, m_sampled = sampled & same; \
        if (ANY(m_evaluated | m_sampled)) { \
            name##_bsdf b = name##_at(scene, s->bsdf, texture_point_of(s), m_evaluated | m_sampled); \
            if (!IS_DISCRETE(traits)) { \
                r.f = v3_pick(m_evaluated, name##_eval(b, s->wi, wo), r.f); \
                r.pdf = m_evaluated ? name##_pdf(b, s->wi, wo) : r.pdf; \
            } \
            r.sample = bsdf_sample_pick(m_sampled, name##_sample(b, s->wi, numbers.u, numbers.lobe), r.sample); \
        } \
    }
    OPAL_BSDFS(RESPOND)
    if (OPAL_HAS_bsdf_mask) r = masked(s, r, numbers.met, sampled);
    return r;
}

// The sample alone.
static BsdfSample bsdf_sample(const Scene *scene, const Surface *s, BsdfNumbers numbers, mask active) {
    return bsdf_respond(scene, s, s->wi, NO_LANES, numbers, active).sample;
}

// The lanes whose BSDF is discrete and nothing else: light sampling cannot serve it.
static mask bsdf_is_discrete(const Scene *scene, uints at) {
    if (DISCRETE_BSDF_KINDS == 0) return NO_LANES;
    uints kind = bsdf_kind(scene, at);
    mask discrete = NO_LANES;
#define ADD_DISCRETE(name, traits) \
    if (OPAL_HAS_bsdf_##name && IS_DISCRETE(traits)) discrete = discrete | bsdf_lanes(kind, BSDF_##name);
    OPAL_BSDFS(ADD_DISCRETE)
    return discrete;
}

// The lanes where wo lies on a side from which light may reach wi: the front, or either where some of the light that
// passes through has a density.
static mask bsdf_is_lit_from(const Scene *scene, uints at, v3 wo) {
    mask lit = wo.z > 0;
    if (BOTH_SIDES_BSDF_KINDS == 0) return lit;
    uints kind = bsdf_kind(scene, at);
#define ADD_LIT(name, traits) \
    if (OPAL_HAS_bsdf_##name && IS_LIT_FROM_BEHIND(traits)) \
        lit = lit | bsdf_lanes(kind, BSDF_##name);
    OPAL_BSDFS(ADD_LIT)
    return lit;
}
