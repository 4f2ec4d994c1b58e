// diffuse: one-sided Lambertian reflection, f = albedo / pi.
//   <bsdf type="diffuse"> <color name="albedo" value="0.5 0.5 0.5"/> <boolean name="use_cosine" value="true"/> </bsdf>
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/warp.cl"
#include "shared/strategy.h"

// The lanes that draw directions in proportion to their cosine: as their material says, which the host sets by
// --hemisphere. A kernel whose materials all do the same has that way alone.
static mask diffuse_by_cosine(diffuse_bsdf b) {
    if (OPAL_AXIS_hemisphere == CHOICE_hemisphere_cosine) return ALL_LANES;
    if (OPAL_AXIS_hemisphere == CHOICE_hemisphere_uniform) return NO_LANES;
    return b.use_cosine;
}

static v3 diffuse_eval(diffuse_bsdf b, v3 wi, v3 wo) {
    mask above = wi.z > 0 & wo.z > 0;
    return v3_scale(b.albedo, above ? (real)(INV_PI) : (real)(0));
}

static real diffuse_pdf(diffuse_bsdf b, v3 wi, v3 wo) {
    mask above = wi.z > 0 & wo.z > 0;
    real density = diffuse_by_cosine(b) ? square_to_cosine_hemisphere_pdf(wo) : square_to_uniform_hemisphere_pdf(wo);
    return above ? density : (real)(0);
}

static BsdfSample diffuse_sample(diffuse_bsdf b, v3 wi, v2 u, real lobe) {
    mask by_cosine = diffuse_by_cosine(b);
    v3 wo = v3_pick(by_cosine, square_to_cosine_hemisphere(u), square_to_uniform_hemisphere(u));
    real weight = by_cosine ? (real)(1) : 2 * wo.z; // cos / pi over the density; the pi cancels
    v3 reflected = v3_scale(b.albedo, wi.z > 0 ? weight : (real)(0));
    return bsdf_sample_of(wo, reflected, diffuse_pdf(b, wi, wo), (real)(1), NO_LANES);
}
