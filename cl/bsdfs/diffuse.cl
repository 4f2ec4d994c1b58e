// diffuse: one-sided Lambertian reflection, f = albedo / pi.
//   <bsdf type="diffuse"> <color name="albedo" value="0.5 0.5 0.5"/> <boolean name="use_cosine" value="true"/> </bsdf>
//   albedo      reflectance of each colour, 0 to 1 (0.5)
//   use_cosine  draw directions in proportion to their cosine, else uniformly (false); this changes the noise alone
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/warp.cl"
#include "scene.cl"

typedef struct { v3 albedo; mask use_cosine; } diffuse_bsdf;

static diffuse_bsdf diffuse_at(const Scene *scene, uints id) {
    diffuse_bsdf b = {GATHER_V3(scene->bsdfs, id, .u.diffuse.albedo),
                      to_mask(GATHER(uints, scene->bsdfs, id, .u.diffuse.use_cosine) != 0)};
    if (CHOSEN(scene, hemisphere, cosine)) b.use_cosine = ALL_LANES;
    if (CHOSEN(scene, hemisphere, uniform)) b.use_cosine = NO_LANES;
    return b;
}

static v3 diffuse_eval(diffuse_bsdf b, v3 wi, v3 wo) {
    mask above = wi.z > 0 & wo.z > 0;
    return v3_scale(b.albedo, above ? (real)(INV_PI) : (real)(0));
}

static real diffuse_pdf(diffuse_bsdf b, v3 wi, v3 wo) {
    mask above = wi.z > 0 & wo.z > 0;
    real density = b.use_cosine ? square_to_cosine_hemisphere_pdf(wo) : square_to_uniform_hemisphere_pdf(wo);
    return above ? density : (real)(0);
}

static BsdfSample diffuse_sample(diffuse_bsdf b, v3 wi, v2 u, real lobe) {
    v3 wo = v3_pick(b.use_cosine, square_to_cosine_hemisphere(u), square_to_uniform_hemisphere(u));
    real weight = b.use_cosine ? (real)(1) : 2 * wo.z; // cos / pi over the density; the pi cancels
    v3 reflected = v3_scale(b.albedo, wi.z > 0 ? weight : (real)(0));
    return bsdf_sample_of(wo, reflected, diffuse_pdf(b, wi, wo), (real)(1), NO_LANES);
}
