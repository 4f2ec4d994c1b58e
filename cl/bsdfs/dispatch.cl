// dispatch: the BSDF of each lane's material, picked by kind. Each kind that the kernel has is computed for all lanes
// as soon as one active lane needs it.
#include "bsdfs/*.cl"
#include "bsdfs/list.h"
#include "bsdfs/perturb.cl"
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
    MIXED_BSDFS = OPAL_HAS_mirror_coats + OPAL_HAS_bsdf_mask + OPAL_HAS_bsdf_blendbsdf * DISCRETE_BSDF_KINDS
                  OPAL_BSDFS(COUNT_MIXED) > 0
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

// Sets the surface's BSDF, frame, wi and opacity to those of the BSDF that nested ones lead to, which is that leaf of
// blends. Returns the leaf with its share.
static BlendLeaf bsdf_open_leaf(const Scene *scene, Surface *s, BlendLeaf leaf, mask active) {
    BsdfOpening o = {s->bsdf, s->wi, s->frame, (real)(1), leaf, NO_LANES};
    for (int i = 0; i < PERTURBATION_PLACES; i++) {
        o.perturbations[i].normal = v3_of((real)(0), (real)(0), (real)(1)); // nothing is perturbed
        o.perturbations[i].shadows = NO_LANES;
    }
    mask opened;
    do {
        uints kind = bsdf_kind(scene, o.at);
        opened = NO_LANES;
#define OPEN(name, traits) \
        if (OPAL_HAS_bsdf_##name) { \
            mask m = active & to_mask(kind == BSDF_##name); \
            if (ANY(m)) { \
                name##_bsdf b = name##_at(scene, o.at, texture_point_of(s), m); \
                o = bsdf_opening_pick(m, name##_open(scene, s, b, o, m), o); \
            } \
            opened = opened | m; \
        }
        OPAL_NESTING_BSDFS(OPEN)
    } while (ANY(opened));
    s->bsdf = o.at;
    s->wi = o.wi;
    s->frame = o.frame;
    s->opacity = o.opacity;
    for (int i = 0; i < OPAL_PERTURBATIONS; i++) s->perturbations[i] = o.perturbations[i];
    return o.leaf;
}

// The same before the functions below are asked. Kernels with blends open a surface once for each leaf instead, where
// they ask it (blend_respond): the surface stays as it was met.
static void bsdf_open(const Scene *scene, Surface *s, mask active) {
    if (NESTING_BSDF_KINDS == 0 || OPAL_HAS_bsdf_blendbsdf) return;
    bsdf_open_leaf(scene, s, blend_leaf(NO_LANES, (real)(0), (uints)(0)), active);
}

// The lanes that are not opened, of kernels with blends.
static mask bsdf_is_nested(uints kind) {
    mask nested = NO_LANES;
#define ADD_NESTED(name, traits) \
    if (OPAL_HAS_bsdf_blendbsdf && OPAL_HAS_bsdf_##name) nested = nested | to_mask(kind == BSDF_##name);
    OPAL_NESTING_BSDFS(ADD_NESTED)
    return nested;
}

// What the BSDFs of a surface answer, one a lane.
typedef struct {
    v3 f;              // f(wi, wo) towards a light, 1/sr, which is to be multiplied by `cosine`; 0 for discrete BSDFs
    real cosine;       // |cos| of wo; 1 where f has it already
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
    real leaf; // which BSDF of a blend; drawn of kernels with blends
} BsdfNumbers;

static BsdfNumbers no_numbers(void) {
    BsdfNumbers none = {v2_of((real)(0), (real)(0)), (real)(0), (real)(0), (real)(0)};
    return none;
}

// The response (bsdf_respond) of an opened surface.
static BsdfResponse opened_respond(const Scene *scene, const Surface *s, v3 wo, mask evaluated, BsdfNumbers numbers,
                                   mask sampled) {
    BsdfResponse r;
    r.f = v3_all((real)(0));
    r.cosine = fabs(wo.z);
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
    if (OPAL_PERTURBATIONS > 0) {
        real lit = perturbation_factor(s, wo), sent = perturbation_factor(s, r.sample.wo);
        sent = r.sample.passes ? (real)(1) : sent; // no surface is met
        r.f = v3_scale(r.f, lit);
        r.pdf = lit > 0 ? r.pdf : (real)(0);
        r.sample.weight = v3_scale(r.sample.weight, sent);
        r.sample.pdf = sent > 0 ? r.sample.pdf : (real)(0);
    }
    return r;
}

// The place of the leaf after this one; 0 where it is the last.
static uints place_after(uints place, uints blends) { return place + ((uints)(0x80000000u) >> (blends - 1u)); }

// The response of a surface whose BSDF may be a blend. One leaf is drawn by the shares, and draws a direction. If that
// has a density, its weight is f cos / pdf of all leaves together, as MIS needs it: each other leaf is asked for the
// direction to the light, and then for the drawn one. Weights are of power, f is of radiance: eta^2 lies between them.
// opened_respond, a kernel's longest code, stands here once.
static BsdfResponse blend_respond(const Scene *scene, const Surface *s, v3 wo, mask evaluated, BsdfNumbers numbers,
                                  mask sampled) {
    v3 to_light = to_world(s->frame, wo), drawn = to_light, drawn_f_cos = to_light;
    real drawn_pdf = 0;
    uints drawn_place = 0, after_drawn = 0;
    Surface opened = *s;
    BlendLeaf leaf = blend_leaf(ALL_LANES, numbers.leaf, (uints)(0));
    BsdfResponse all;
    mask asked = evaluated | sampled, mixed = NO_LANES; // mixed: those whose sample has a density of several leaves
    int turn = 0;                                       // 0: the drawn leaf; 1, 2: another one, for either direction
    do {
        v3 direction = turn == 2 ? drawn : to_light;
        mask m = turn == 2 ? asked & mixed : asked & evaluated;
        if (turn != 2) {
            opened = *s;
            leaf = bsdf_open_leaf(scene, &opened, leaf, asked);
        }
        BsdfResponse r = opened_respond(scene, &opened, to_local(opened.frame, direction), m, numbers,
                                        turn == 0 ? sampled : NO_LANES);
        real chance = drawn_probability(leaf.high) - drawn_probability(leaf.low);
        v3 f_cos = v3_scale(r.f, leaf.share * r.cosine);
        real pdf = chance * r.pdf;
        if (turn == 0) {
            all = r;
            all.f = f_cos;
            all.cosine = 1;
            all.pdf = pdf;
            asked = asked & to_mask(leaf.blends > 0u);
            mixed = asked & sampled & !r.sample.discrete & (r.sample.pdf > 0);
            drawn = to_world(opened.frame, r.sample.wo);
            drawn_f_cos = v3_scale(r.sample.weight, leaf.share * r.sample.pdf);
            drawn_pdf = chance * r.sample.pdf;
            all.sample.wo = to_local(s->frame, drawn);
            all.sample.weight = v3_scale(r.sample.weight, asked & sampled ? leaf.share / chance : (real)(1));
            drawn_place = leaf.place;
            after_drawn = place_after(leaf.place, leaf.blends);
            leaf = blend_leaf(NO_LANES, (real)(0), uints_pick(to_mask(drawn_place == 0u), after_drawn, (uints)(0)));
            turn = 1;
        } else if (turn == 1) {
            all.f = v3_add(all.f, f_cos);
            all.pdf = all.pdf + pdf;
            turn = 2;
        } else {
            drawn_f_cos = v3_mad(f_cos, square(all.sample.eta), drawn_f_cos);
            drawn_pdf = drawn_pdf + pdf;
            uints next = place_after(leaf.place, leaf.blends);
            next = uints_pick(to_mask(next == drawn_place) & to_mask(next != 0u), after_drawn, next);
            asked = asked & to_mask(next != 0u);
            leaf = blend_leaf(NO_LANES, (real)(0), next);
            turn = 1;
        }
    } while (ANY(asked));
    all.sample.weight = v3_pick(mixed, v3_scale(drawn_f_cos, 1 / drawn_pdf), all.sample.weight);
    all.sample.pdf = mixed ? drawn_pdf : all.sample.pdf;
    return all;
}

// Evaluates the surface's BSDFs in direction wo, in the lanes of `evaluated`, and draws a direction by `numbers` in
// those of `sampled`. f, pdf and the weight are 0 in other lanes. Both in one call, because each kind's code is
// compiled, and each material read, once a call.
static BsdfResponse bsdf_respond(const Scene *scene, const Surface *s, v3 wo, mask evaluated, BsdfNumbers numbers,
                                 mask sampled) {
    if (OPAL_HAS_bsdf_blendbsdf) return blend_respond(scene, s, wo, evaluated, numbers, sampled);
    return opened_respond(scene, s, wo, evaluated, numbers, sampled);
}

// The sample alone.
static BsdfSample bsdf_sample(const Scene *scene, const Surface *s, BsdfNumbers numbers, mask active) {
    return bsdf_respond(scene, s, s->wi, NO_LANES, numbers, active).sample;
}

// The lanes whose BSDF is discrete and nothing else: light sampling cannot serve it. None of those that kernels with
// blends do not open.
static mask bsdf_is_discrete(const Scene *scene, uints at) {
    if (DISCRETE_BSDF_KINDS == 0) return NO_LANES;
    uints kind = bsdf_kind(scene, at);
    mask discrete = NO_LANES, opened = !bsdf_is_nested(kind);
#define ADD_DISCRETE(name, traits) \
    if (OPAL_HAS_bsdf_##name && IS_DISCRETE(traits)) discrete = discrete | bsdf_lanes(kind, BSDF_##name);
    OPAL_BSDFS(ADD_DISCRETE)
    return OPAL_HAS_bsdf_blendbsdf ? discrete & opened : discrete;
}

// The lanes where wo lies on a side from which light may reach wi: the front, or either where some of the light that
// passes through has a density, or a kernel with blends does not open the BSDF.
static mask bsdf_is_lit_from(const Scene *scene, uints at, v3 wo) {
    mask lit = wo.z > 0;
    if (BOTH_SIDES_BSDF_KINDS + OPAL_HAS_bsdf_blendbsdf == 0) return lit;
    uints kind = bsdf_kind(scene, at);
    if (OPAL_HAS_bsdf_blendbsdf) lit = lit | bsdf_is_nested(kind);
#define ADD_LIT(name, traits) \
    if (OPAL_HAS_bsdf_##name && IS_LIT_FROM_BEHIND(traits)) \
        lit = lit | bsdf_lanes(kind, BSDF_##name);
    OPAL_BSDFS(ADD_LIT)
    return lit;
}
