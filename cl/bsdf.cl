// bsdf: what every BSDF offers, and the dispatch made from the list (bsdfs/list.h).
//
// Local frame: z is the shading normal; wi points to the viewer, wo to the light; both unit, both away from the surface.
//   NAME_bsdf NAME_at(scene, id)                 parameters of the materials `id`, one a lane
//   v3   NAME_eval(b, wi, wo)                    f(wi, wo) without the cosine, 1/sr; 0 for discrete BSDFs
//   real NAME_pdf(b, wi, wo)                     density of NAME_sample over solid angle, 1/sr; 0 for discrete BSDFs
//   BsdfSample NAME_sample(b, wi, u, lobe)       draws wo from u and lobe in [0, 1), and says its density
// A sample's weight is f cos / pdf (discrete: what remains of the radiance); 0 where nothing is reflected, never NaN.
typedef struct {
    v3 wo, weight;
    real pdf;        // NAME_pdf of wo: by the numbers that drew it, where they lose less
    real eta;        // index of refraction of wo's side over wi's side
    mask discrete;   // wo has no density: no light sampling can find it
} BsdfSample;

static BsdfSample bsdf_sample_of(v3 wo, v3 weight, real pdf, real eta, mask discrete) {
    BsdfSample s = {wo, weight, pdf, eta, discrete};
    return s;
}

#include "bsdfs/diffuse.cl"
#include "bsdfs/mirror.cl"
#include "bsdfs/dielectric.cl"
#include "bsdfs/microfacet.cl"
#include "bsdfs/phong.cl"

#define COUNT_BSDF(name) +OPAL_HAS_bsdf_##name
enum { BSDF_KINDS = 0 OPAL_BSDFS(COUNT_BSDF) }; // that this kernel has

// For each kind that the kernel has and that some lane of `live` needs: BODY with `b`, its parameters, and `m`, its lanes.
#define FOR_BSDF(name, BODY) \
    if (OPAL_HAS_bsdf_##name) { \
        mask m = BSDF_KINDS == 1 ? live : live & to_mask(kind == BSDF_##name); \
        if (ANY(m)) { \
            name##_bsdf b = name##_at(scene, id); \
            BODY(name) \
        } \
    }

static uints bsdf_kind(const Scene *scene, uints id) { return GATHER(uints, scene->bsdfs, id, .kind); }

// f(wi, wo) of the materials `id`, and its density by bsdf_sample.
static v3 bsdf_eval(const Scene *scene, uints id, v3 wi, v3 wo, mask live, real *pdf) {
    v3 f = v3_all((real)(0));
    *pdf = 0;
    uints kind = bsdf_kind(scene, id);
#define EVAL(name) f = v3_pick(m, name##_eval(b, wi, wo), f); *pdf = m ? name##_pdf(b, wi, wo) : *pdf;
#define EVAL_KIND(name) FOR_BSDF(name, EVAL)
    OPAL_BSDFS(EVAL_KIND)
    return f;
}

static BsdfSample bsdf_sample(const Scene *scene, uints id, v3 wi, v2 u, real lobe, mask live) {
    BsdfSample s = bsdf_sample_of(wi, v3_all((real)(0)), (real)(0), (real)(1), NO_LANES);
    uints kind = bsdf_kind(scene, id);
#define SAMPLE(name) \
        BsdfSample t = name##_sample(b, wi, u, lobe); \
        s.wo = v3_pick(m, t.wo, s.wo); s.weight = v3_pick(m, t.weight, s.weight); \
        s.pdf = m ? t.pdf : s.pdf; s.eta = m ? t.eta : s.eta; s.discrete = s.discrete | (m & t.discrete);
#define SAMPLE_KIND(name) FOR_BSDF(name, SAMPLE)
    OPAL_BSDFS(SAMPLE_KIND)
    return s;
}

// Materials that light sampling cannot serve: discrete ones.
static mask bsdf_is_discrete(const Scene *scene, uints id) {
    uints kind = bsdf_kind(scene, id);
    mask discrete = NO_LANES;
    if (OPAL_HAS_bsdf_mirror) discrete = discrete | to_mask(kind == BSDF_mirror);
    if (OPAL_HAS_bsdf_dielectric) discrete = discrete | to_mask(kind == BSDF_dielectric);
    return discrete;
}
