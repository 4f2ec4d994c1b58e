// microfacet: rough dielectric coat over a diffuse base, one-sided, as Nori has it.
//   <bsdf type="microfacet"> <float name="alpha" value="0.1"/> <color name="kd" value="0.5"/> ... </bsdf>
// f = kd/pi + ks D(h) F(wi.h) G / (4 cos_i cos_o cos_h), with D the density of h over solid angle (hence the last
// cosine), G Smith's rational approximation for Beckmann (Walter et al. 2007, section 5.2). With
// <string name="distribution" value="ggx"/>, which Nori has not, D and G are those of GGX (microfacet_distribution.cl).
// At alpha 0 the coat is a mirror that reflects ks F: it is sampled as a discrete direction, and eval and pdf are those
// of the base.
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "bsdfs/microfacet.h"
#include "bsdfs/microfacet_distribution.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"

// The specular reflectance of the coat, 1 - max(kd), and the probability to draw from it: the same as random numbers
// have it.
static real microfacet_ks(microfacet_bsdf b) { return 1 - v3_largest(b.kd); }
static real microfacet_coat_chance(microfacet_bsdf b) { return drawn_probability(microfacet_ks(b)); }

// The distribution of GGX's facets. Directions are drawn of all of them, not of visible ones.
static MicrofacetDistribution microfacet_ggx(microfacet_bsdf b) {
    MicrofacetDistribution m = {b.alpha, b.alpha, ALL_LANES, NO_LANES};
    return m;
}

// Smith's shadowing of direction w by facets of normal h; Beckmann's in Walter's rational approximation.
static real microfacet_g1(microfacet_bsdf b, v3 w, v3 h) {
    // Walter's a = cos / (alpha sin) is multiplied out, as sin is 0 at the pole.
    real c = w.z, s = b.alpha * sqrt(sin2_theta(w));
    real rational = c * (R(3.535) * s + R(2.181) * c) / (s * s + c * (R(2.276) * s + R(2.577) * c));
    real g = c < R(1.6) * s ? rational : (real)(1);
    if (OPAL_HAS_ggx) g = facets_are_ggx(b.ggx) ? fabs(c) * facet_masking(microfacet_ggx(b), w) : g;
    return v3_dot(w, h) * w.z > 0 ? g : (real)(0);
}

// The coat without D: ks F G / divisor.
static real microfacet_coat(microfacet_bsdf b, v3 wi, v3 wo, v3 h, real divisor) {
    real cosine = v3_dot(wi, h);
    real sin2 = 1 - square(cosine);
    real f = fresnel_dielectric(fabs(cosine), real_max(sin2, (real)(0)), boundary_of(b.ext_ior, b.int_ior));
    return microfacet_ks(b) * f * microfacet_g1(b, wi, h) * microfacet_g1(b, wo, h) / divisor;
}

// The lanes whose coat is a mirror. Asked where OPAL_HAS_mirror_coats.
static mask microfacet_is_mirror(microfacet_bsdf b) { return b.alpha < (real)(MICROFACET_MIRROR_ALPHA); }

// D, the density of h over solid angle; 0 of a mirror.
static real microfacet_d(microfacet_bsdf b, v3 h) {
    real d = square_to_beckmann_pdf(h, b.alpha);
    if (OPAL_HAS_ggx) d = facets_are_ggx(b.ggx) ? h.z * facet_density(microfacet_ggx(b), h) : d;
    if (!OPAL_HAS_mirror_coats) return d;
    return microfacet_is_mirror(b) ? (real)(0) : d;
}

static v3 microfacet_eval(microfacet_bsdf b, v3 wi, v3 wo) {
    mask above = wi.z > 0 & wo.z > 0;
    v3 h = v3_normalize(v3_add(wi, wo));
    real coat = microfacet_coat(b, wi, wo, h, 4 * wi.z * wo.z * h.z) * microfacet_d(b, h);
    v3 f = v3_add(v3_scale(b.kd, (real)(INV_PI)), v3_all(coat));
    return v3_pick(above, f, v3_all((real)(0)));
}

// c D / (4 h.wo) + (1 - c) cos_o / pi, where c is the chance of the coat. It integrates to less than 1, because the
// coat draws some directions below the surface.
static real microfacet_pdf(microfacet_bsdf b, v3 wi, v3 wo) {
    v3 h = v3_normalize(v3_add(wi, wo));
    real coat = microfacet_d(b, h) / (4 * fabs(v3_dot(h, wo)));
    real coat_chance = microfacet_coat_chance(b);
    real density = coat_chance * coat + (1 - coat_chance) * square_to_cosine_hemisphere_pdf(wo);
    return (wi.z > 0 & wo.z > 0) ? density : (real)(0);
}

// The weight uses the h that was drawn. An h recomputed from wo is off by an ulp of wo, which a small alpha magnifies.
static BsdfSample microfacet_sample(microfacet_bsdf b, v3 wi, v2 u, real lobe) {
    real coat_chance = microfacet_coat_chance(b);
    mask coated = lobe < coat_chance;
    v3 facet = square_to_beckmann(u, b.alpha);
    if (OPAL_HAS_ggx) facet = v3_pick(facets_are_ggx(b.ggx), facet_sample(microfacet_ggx(b), wi, u), facet);
    v3 mirrored = v3_sub(v3_scale(facet, 2 * v3_dot(wi, facet)), wi);
    v3 wo = v3_pick(coated, mirrored, square_to_cosine_hemisphere(u));
    v3 h = v3_pick(coated, facet, v3_normalize(v3_add(wi, wo)));
    real d = microfacet_d(b, h);
    real base = wo.z * INV_PI;
    real density = coat_chance * d / (4 * fabs(v3_dot(h, wo))) + (1 - coat_chance) * base;
    v3 f_cos = v3_add(v3_scale(b.kd, base), v3_all(microfacet_coat(b, wi, wo, h, 4 * wi.z * h.z) * d));
    mask kept = wi.z > 0 & wo.z > 0 & density > 0;
    v3 weight = v3_pick(kept, v3_scale(f_cos, 1 / density), v3_all((real)(0)));
    if (!OPAL_HAS_mirror_coats) return bsdf_sample_of(wo, weight, kept ? density : (real)(0), (real)(1), NO_LANES);
    mask specular = coated & microfacet_is_mirror(b) & wi.z > 0;
    weight = v3_pick(specular, v3_all(microfacet_coat(b, wi, wo, h, coat_chance)), weight);
    kept = kept & !specular;
    return bsdf_sample_of(wo, weight, kept ? density : (real)(0), (real)(1), specular);
}
