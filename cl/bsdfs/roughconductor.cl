// roughconductor: a metal of rough facets, one-sided.
//   <bsdf type="roughconductor"> <string name="material" value="Cu"/> <string name="distribution" value="ggx"/>
//     <float name="alpha" value="0.2"/> </bsdf>
// f = F(wi.h) D(h) G1(wi) G1(wo) / (4 cos_i cos_o) (Walter et al. 2007, eq. 20), with Fresnel's reflectance F of the
// complex index and the masking of both directions taken to be independent, as Mitsuba has it.
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "bsdfs/microfacet_distribution.cl"
#include "core/lanes.cl"
#include "core/math.cl"

static MicrofacetDistribution roughconductor_facets(roughconductor_bsdf b) {
    return facets_of(b.alpha_u, b.alpha_v, b.ggx, b.sample_visible);
}

// What a facet reflects of light that meets it under this cosine.
static v3 roughconductor_fresnel(roughconductor_bsdf b, real cosine) {
    real sin2 = real_max(1 - square(cosine), (real)(0));
    return v3_mul(b.specular_reflectance, fresnel_conductor(cosine, sin2, b.eta, b.k));
}

static v3 roughconductor_eval(roughconductor_bsdf b, v3 wi, v3 wo) {
    MicrofacetDistribution m = roughconductor_facets(b);
    v3 h = v3_normalize(v3_add(wi, wo));
    real facets = R(0.25) * facet_density(m, h) * facet_masking(m, wi) * facet_masking(m, wo);
    mask above = wi.z > 0 & wo.z > 0;
    return v3_pick(above, v3_scale(roughconductor_fresnel(b, v3_dot(wi, h)), facets), v3_all((real)(0)));
}

static real roughconductor_pdf(roughconductor_bsdf b, v3 wi, v3 wo) {
    MicrofacetDistribution m = roughconductor_facets(b);
    v3 h = v3_normalize(v3_add(wi, wo));
    real density = R(0.25) * facet_density(m, h) * facet_chance(m, wi, h);
    return (wi.z > 0 & wo.z > 0) ? density : (real)(0);
}

// The weight uses the h that was drawn. An h recomputed from wo is off by an ulp of wo, which a small alpha magnifies.
static BsdfSample roughconductor_sample(roughconductor_bsdf b, v3 wi, v2 u, real lobe) {
    MicrofacetDistribution m = roughconductor_facets(b);
    v3 h = facet_sample(m, wi, u);
    real cosine = v3_dot(wi, h);
    v3 wo = v3_sub(v3_scale(h, 2 * cosine), wi);
    real chance = facet_chance(m, wi, h);
    real masking = facet_masking(m, wi) / chance * facet_masking(m, wo) * wo.z;
    mask kept = wi.z > 0 & wo.z > 0 & cosine > 0;
    v3 weight = v3_pick(kept, v3_scale(roughconductor_fresnel(b, cosine), masking), v3_all((real)(0)));
    real pdf = kept ? R(0.25) * facet_density(m, h) * chance : (real)(0);
    return bsdf_sample_of(wo, weight, pdf, (real)(1), NO_LANES);
}
