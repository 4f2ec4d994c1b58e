// interface: what every BSDF offers (bsdfs/NAME.cl for each row of bsdfs/list.h).
//
// Directions are in the local frame: z is the shading normal, wi points to the viewer, wo to the light; both are unit
// and point away from the surface.
//   v3   NAME_eval(b, wi, wo)                   f(wi, wo) without the cosine, 1/sr; 0 for discrete BSDFs
//   real NAME_pdf(b, wi, wo)                    density of NAME_sample, solid angle measure, 1/sr; 0 of discrete BSDFs,
//                                               and, if that is simpler, where weights are 0
//   BsdfSample NAME_sample(b, wi, u, lobe)      draws wo by random numbers u and lobe in [0, 1)
// A BSDF that leads to others (OPAL_NESTING_BSDFS) offers this alone:
//   BsdfOpening NAME_open(scene, s, b, o, m)    the BSDF to ask in its place of the surface s, and the directions to
//                                               ask it with, in the lanes of m
// b is a NAME_bsdf, the lanes' parameters; NAME_at reads them. Both are made of bsdfs/NAME.h below.
// Functions compute all lanes; their callers pick those that are meant.
#include "bsdfs/list.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "parameters.cl"
#include "scene.cl"
#include "surface.cl"
#include "textures/interface.cl"

// NAME_bsdf, and NAME_at: the parameters at `point` of the BSDFs whose records begin at word `at`. Lanes that are not
// active may have records of other kinds: the host pads the table, so that no read passes its end.
#define BSDF_READER(name, traits) \
    typedef struct { \
        uints at; \
        OPAL_BSDF_##name(LANES_MEMBER) \
    } name##_bsdf; \
    static name##_bsdf name##_at(const Scene *scene, uints at, TexturePoint point, mask active) { \
        enum { OPAL_BSDF_##name(PARAMETER_PLACE) textured = OPAL_TEXTURED_bsdf_##name, \
               nonzero = OPAL_NONZERO_bsdf_##name }; \
        global const bsdf_##name##_record *record = (global const bsdf_##name##_record *)scene->bsdfs; \
        name##_bsdf lanes; \
        lanes.at = at; \
        OPAL_BSDF_##name(READ_PARAMETER) \
        return lanes; \
    }
OPAL_ALL_BSDFS(BSDF_READER)

// A leaf of a tree of blends (bsdfs/blendbsdf.cl): a BSDF that is none. The leaves have consecutive intervals of
// [0, 1): each blend cuts its own one in two.
typedef struct {
    mask drawn;     // the leaf is found by `number`, else by `place`
    real number;    // random, in [0, 1)
    uints place;    // where its interval begins, in 2^-32, if the cuts are in the middle
    uints blends;   // that lead to it: that interval's length is 2^-blends
    real share;     // of the leaf in the tree
    real low, high; // the numbers that find it, if the cuts are by the shares
} BlendLeaf;

static BlendLeaf blend_leaf(mask drawn, real number, uints place) {
    BlendLeaf leaf = {drawn, number, place, (uints)(0), (real)(1), (real)(0), (real)(1)};
    return leaf;
}

static BlendLeaf blend_leaf_pick(mask m, BlendLeaf yes, BlendLeaf no) {
    BlendLeaf leaf = {no.drawn, no.number, uints_pick(m, yes.place, no.place), uints_pick(m, yes.blends, no.blends),
                      m ? yes.share : no.share, m ? yes.low : no.low, m ? yes.high : no.high};
    return leaf;
}

// A BSDF and how a surface asks it.
typedef struct {
    uints at;       // first word of its record
    v3 wi;          // towards the viewer, in `frame`
    Frame frame;    // around the shading normal
    real opacity;   // the probability that light meets the BSDF (bsdfs/mask.cl)
    BlendLeaf leaf; // of kernels with blends
    mask mirrored;  // `frame` is left-handed: a twosided is seen from behind
    Perturbation perturbations[PERTURBATION_PLACES]; // as in Surface
} BsdfOpening;

static BsdfOpening bsdf_opening_pick(mask m, BsdfOpening yes, BsdfOpening no) {
    BsdfOpening o = {uints_pick(m, yes.at, no.at),
                     v3_pick(m, yes.wi, no.wi),
                     {v3_pick(m, yes.frame.s, no.frame.s), v3_pick(m, yes.frame.t, no.frame.t),
                      v3_pick(m, yes.frame.n, no.frame.n)},
                     m ? yes.opacity : no.opacity,
                     blend_leaf_pick(m, yes.leaf, no.leaf),
                     (m & yes.mirrored) | (no.mirrored & !m)};
    for (int i = 0; i < PERTURBATION_PLACES; i++) {
        o.perturbations[i].normal = v3_pick(m, yes.perturbations[i].normal, no.perturbations[i].normal);
        o.perturbations[i].shadows = (m & yes.perturbations[i].shadows) | (no.perturbations[i].shadows & !m);
    }
    return o;
}

typedef struct {
    v3 wo;           // unit
    v3 weight;       // f cos / pdf, of a discrete BSDF the part of the power; 0 where nothing is reflected, never NaN
    real pdf;        // equals NAME_pdf(wo) up to rounding; 0 where discrete
    real eta;        // index of refraction of wo's side over wi's side; paths of radiance divide by its square
    mask discrete;   // wo has no density, so that light sampling cannot find it
    mask passes;     // wo is -wi, because the surface is not met (bsdfs/null.cl, mask.cl)
} BsdfSample;

static BsdfSample bsdf_sample_of(v3 wo, v3 weight, real pdf, real eta, mask discrete) {
    BsdfSample s = {wo, weight, pdf, eta, discrete, NO_LANES};
    return s;
}

// A sample that passes through the surface, with the same weight in all channels.
static BsdfSample passing_sample(v3 wi, real weight) {
    BsdfSample s = bsdf_sample_of(v3_neg(wi), v3_all(weight), (real)(0), (real)(1), ALL_LANES);
    s.passes = ALL_LANES;
    return s;
}

static BsdfSample bsdf_sample_pick(mask m, BsdfSample yes, BsdfSample no) {
    BsdfSample s = bsdf_sample_of(v3_pick(m, yes.wo, no.wo), v3_pick(m, yes.weight, no.weight), m ? yes.pdf : no.pdf,
                                  m ? yes.eta : no.eta, m ? yes.discrete : no.discrete);
    s.passes = m ? yes.passes : no.passes;
    return s;
}
