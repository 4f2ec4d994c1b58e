// roughplastic: a transparent coat of rough facets over a diffuse base, one-sided, as Mitsuba has it.
//   <bsdf type="roughplastic"> <color name="diffuse_reflectance" value="0.1 0.3 0.6"/>
//     <float name="alpha" value="0.2"/> </bsdf>
// The facets reflect as those of roughconductor, by Fresnel's reflectance of a dielectric. The base is that of plastic,
// with T(w) what facets transmit of light from w, and R what they reflect back (host/flatten/plastic_boundary.h).
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "bsdfs/microfacet_distribution.cl"
#include "bsdfs/plastic.cl"
#include "bsdfs/plastic.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"
#include "parameters.cl"

static MicrofacetDistribution roughplastic_facets(roughplastic_bsdf b) {
    return facets_of(b.alpha, b.alpha, b.ggx, b.sample_visible);
}

static real roughplastic_transmitted(roughplastic_bsdf b, real cosine) {
    return curve_at(b.boundary, PLASTIC_TRANSMITTED, PLASTIC_COSINES, cosine);
}

// The probability to draw the facets.
static real roughplastic_coat_chance(roughplastic_bsdf b, v3 wi) {
    real reflected = 1 - roughplastic_transmitted(b, wi.z);
    return plastic_coat_chance(b.specular_reflectance, b.diffuse_reflectance, reflected);
}

// What the facets of normal h reflect, without their density D; and of the base f.
static v3 roughplastic_coat(roughplastic_bsdf b, MicrofacetDistribution m, v3 wi, v3 wo, v3 h) {
    real cosine = v3_dot(wi, h);
    real fresnel = fresnel_dielectric(fabs(cosine), real_max(1 - square(cosine), (real)(0)),
                                      boundary_of(b.ext_ior, b.int_ior));
    return v3_scale(b.specular_reflectance, R(0.25) * fresnel * facet_masking(m, wi) * facet_masking(m, wo));
}
static v3 roughplastic_base(roughplastic_bsdf b, v3 wi, v3 wo) {
    real transmitted = roughplastic_transmitted(b, wi.z) * roughplastic_transmitted(b, wo.z);
    return v3_scale(plastic_base(b.diffuse_reflectance, b.nonlinear,
                                 curve_number(b.boundary, (uints)(PLASTIC_INSIDE)), square(b.int_ior / b.ext_ior),
                                 transmitted), (real)(INV_PI));
}

static v3 roughplastic_eval(roughplastic_bsdf b, v3 wi, v3 wo) {
    MicrofacetDistribution m = roughplastic_facets(b);
    v3 h = v3_normalize(v3_add(wi, wo));
    mask above = wi.z > 0 & wo.z > 0;
    v3 f = v3_mad(roughplastic_coat(b, m, wi, wo, h), facet_density(m, h), roughplastic_base(b, wi, wo));
    return v3_pick(above, f, v3_all((real)(0)));
}

static real roughplastic_pdf(roughplastic_bsdf b, v3 wi, v3 wo) {
    MicrofacetDistribution m = roughplastic_facets(b);
    v3 h = v3_normalize(v3_add(wi, wo));
    real coat = drawn_probability(roughplastic_coat_chance(b, wi));
    real density = coat * R(0.25) * facet_density(m, h) * facet_chance(m, wi, h) +
                   (1 - coat) * square_to_cosine_hemisphere_pdf(wo);
    return (wi.z > 0 & wo.z > 0) ? density : (real)(0);
}

// As roughconductor_sample, the weight uses the facet that was drawn.
static BsdfSample roughplastic_sample(roughplastic_bsdf b, v3 wi, v2 u, real lobe) {
    MicrofacetDistribution m = roughplastic_facets(b);
    real coat = drawn_probability(roughplastic_coat_chance(b, wi));
    mask coated = lobe < coat;
    v3 facet = facet_sample(m, wi, u);
    v3 mirrored = v3_sub(v3_scale(facet, 2 * v3_dot(wi, facet)), wi);
    v3 wo = v3_pick(coated, mirrored, square_to_cosine_hemisphere(u));
    v3 h = v3_pick(coated, facet, v3_normalize(v3_add(wi, wo)));
    real d = facet_density(m, h);
    real density = coat * R(0.25) * d * facet_chance(m, wi, h) + (1 - coat) * wo.z * INV_PI;
    v3 f = v3_mad(roughplastic_coat(b, m, wi, wo, h), d, roughplastic_base(b, wi, wo));
    mask kept = wi.z > 0 & wo.z > 0 & density > 0;
    v3 weight = v3_pick(kept, v3_scale(f, wo.z / density), v3_all((real)(0)));
    return bsdf_sample_of(wo, weight, kept ? density : (real)(0), (real)(1), NO_LANES);
}
