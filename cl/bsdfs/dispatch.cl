// dispatch: the BSDF of each lane's material, picked by kind. Each kind that the kernel has is computed for all lanes
// as soon as one active lane needs it.
#include "bsdfs/*.cl"
#include "bsdfs/list.h"
#include "core/lanes.cl"
#include "scene.cl"

#define COUNT_BSDF(name) +OPAL_HAS_bsdf_##name
enum { BSDF_KINDS = 0 OPAL_BSDFS(COUNT_BSDF) }; // of this kernel

static uints bsdf_kind(const Scene *scene, uints id) { return GATHER(uints, scene->bsdfs, id, .kind); }

// The active lanes whose material is of that kind.
static mask bsdf_lanes(uints kind, uint wanted, mask active) {
    return BSDF_KINDS == 1 ? active : active & to_mask(kind == wanted);
}

// f(wi, wo) of the materials `id`, without the cosine, 1/sr, and in *pdf the density with which bsdf_sample draws wo,
// solid angle measure. Both are 0 for discrete BSDFs and in lanes that are not active.
static v3 bsdf_eval(const Scene *scene, uints id, v3 wi, v3 wo, mask active, real *pdf) {
    v3 f = v3_all((real)(0));
    *pdf = 0;
    uints kind = bsdf_kind(scene, id);
#define EVAL(name) \
    if (OPAL_HAS_bsdf_##name) { \
        mask m = bsdf_lanes(kind, BSDF_##name, active); \
        if (ANY(m)) { \
            name##_bsdf b = name##_at(scene, id); \
            f = v3_pick(m, name##_eval(b, wi, wo), f); \
            *pdf = m ? name##_pdf(b, wi, wo) : *pdf; \
        } \
    }
    OPAL_BSDFS(EVAL)
    return f;
}

// Draws wo by the materials `id`; u and lobe in [0, 1) are independent. The weight is 0 in lanes that are not active.
static BsdfSample bsdf_sample(const Scene *scene, uints id, v3 wi, v2 u, real lobe, mask active) {
    BsdfSample s = bsdf_sample_of(wi, v3_all((real)(0)), (real)(0), (real)(1), NO_LANES);
    uints kind = bsdf_kind(scene, id);
#define SAMPLE(name) \
    if (OPAL_HAS_bsdf_##name) { \
        mask m = bsdf_lanes(kind, BSDF_##name, active); \
        if (ANY(m)) s = bsdf_sample_pick(m, name##_sample(name##_at(scene, id), wi, u, lobe), s); \
    }
    OPAL_BSDFS(SAMPLE)
    return s;
}

// The lanes whose material is discrete: light sampling cannot serve it.
static mask bsdf_is_discrete(const Scene *scene, uints id) {
    uints kind = bsdf_kind(scene, id);
    mask discrete = NO_LANES;
    if (OPAL_HAS_bsdf_mirror) discrete = discrete | to_mask(kind == BSDF_mirror);
    if (OPAL_HAS_bsdf_dielectric) discrete = discrete | to_mask(kind == BSDF_dielectric);
    return discrete;
}
