// principled: Disney's material as Mitsuba 3 has it (bsdfs/disney.cl names the papers).
//   <bsdf type="principled"> <color name="baseColor" value="0.8 0.4 0.2"/> <float name="metallic" value="1"/> </bsdf>
// The front has a diffuse base with sheen, GGX facets that reflect like metal or a dielectric and refract by
// spec_trans, and a clear coat; the back has the rough glass alone. Transmitted light is multiplied by
// sqrt(base_color), so that a way in and out has the colour once. The lobes do not know of each other, so that the sum
// may reflect more than it gets: up to 1.44 times.
#include "bsdfs/disney.cl"
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "bsdfs/microfacet_distribution.cl"
#include "bsdfs/principled.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"

#define PRINCIPLED_PLACE(type, name, xml, initial, range, meaning) PRINCIPLED_##name,
enum { OPAL_BSDF_principled(PRINCIPLED_PLACE) };
// Whether the parameter is above 0 in some material of the kernel's scene. A lobe without it is left out.
#define PRINCIPLED_HAS(name) (OPAL_NONZERO_bsdf_principled >> PRINCIPLED_##name & 1)

// The coat's distribution of facets over solid angle, GTR1 (2012, appendix B, equation 4): sin^2 + alpha^2 cos^2 is
// 1 + (alpha^2 - 1) cos^2 without its cancellation. Its shadowing is that of GGX with alpha 0.25.
#define COAT_SHADOWING_ALPHA R(0.25)
#define COAT_AT_NORMAL R(0.04)  // its reflectance at normal incidence
static real coat_alpha(principled_bsdf b) { return R(0.1) + (R(0.001) - R(0.1)) * b.clearcoat_gloss; }
static real gtr1(v3 h, real alpha) {
    real alpha2 = square(alpha);
    return (alpha2 - 1) * INV_PI / (2 * log(alpha) * (sin2_theta(h) + alpha2 * square(h.z)));
}
// A normal of those facets, by their density gtr1 cos (2012, appendix B, equation 6).
static v3 square_to_gtr1(v2 u, real alpha) {
    real alpha2 = square(alpha);
    real sin2 = alpha2 * expm1(-2 * u.x * log(alpha)) / (1 - alpha2);
    return direction_of(safe_sqrt(1 - sin2), sqrt(sin2), u.y);
}

// What does not depend on directions but on the side of wi.
typedef struct {
    mask front, lit;                // of wi; whether light is reflected or transmitted there at all
    real diffuse, glass;            // weights of the base and of the glass
    real coat;                      // that of the coat
    MicrofacetDistribution facets;
    Boundary boundary;              // from the side of wi to the other
    // A lobe is drawn by one random number: below below_base the base, then below below_coat the coat, then the facets,
    // which transmit with a chance of transmits (1 - F), and reflect with the rest.
    real below_base, below_coat, transmits;
} PrincipledLobes;

static PrincipledLobes principled_lobes(principled_bsdf b, v3 wi) {
    PrincipledLobes l;
    l.front = wi.z > 0;
    l.glass = (1 - b.metallic) * b.spec_trans;
    l.diffuse = (1 - b.metallic) * (1 - b.spec_trans);
    l.coat = R(0.25) * b.clearcoat;
    l.lit = l.front;
    if (PRINCIPLED_HAS(spec_trans)) l.lit = l.front | (wi.z < 0 & l.glass > 0);
    l.facets = disney_facets(b.roughness, b.anisotropic);
    l.boundary = boundary_of(l.front ? (real)(1) : b.eta, l.front ? b.eta : (real)(1));
    real share = l.front ? 1 / (1 + l.diffuse + l.coat) : (real)(0);
    l.below_base = drawn_probability(share * l.diffuse);
    l.below_coat = l.below_base + drawn_probability(share * l.coat);
    l.transmits = l.front ? share * l.glass : (real)(1);
    return l;
}

// Fresnel's reflectance of the facets, at the cosine of incidence.
static real principled_facet_fresnel(PrincipledLobes l, real cosine) {
    return fresnel_dielectric(cosine, real_max(1 - square(cosine), (real)(0)), l.boundary);
}

// A number below this draws the base, the coat or transmission.
static real principled_below_transmission(PrincipledLobes l, real fresnel) {
    if (!PRINCIPLED_HAS(spec_trans)) return l.below_coat;
    return real_min(l.below_coat + drawn_probability(l.transmits * (1 - fresnel)), (real)(1));
}

// What the facets reflect: of the front metal and dielectric, of the back glass.
static v3 principled_reflectance(principled_bsdf b, PrincipledLobes l, real fresnel, real cosine) {
    v3 metal = schlick(b.base_color, schlick_weight_at(cosine, b.eta));
    v3 dielectric = disney_fresnel(fresnel, b.base_color, b.spec_tint, cosine, b.eta);
    v3 front = v3_mad(metal, b.metallic, v3_scale(dielectric, 1 - b.metallic));
    return PRINCIPLED_HAS(spec_trans) ? v3_pick(l.front, front, v3_all(l.glass * fresnel)) : front;
}

// All lobes between wi and wo, of which h is the half vector; f of radiance. Directions are on the side of wi: wi.z and
// h.z are positive. fresnel: that of the facets at wi.h
static BsdfValue principled_value(principled_bsdf b, PrincipledLobes l, v3 wi, v3 wo, v3 h, real fresnel) {
    real i = v3_dot(wi, h), o = v3_dot(wo, h);
    mask reflects = l.lit & (wo.z > 0) & (i > 0) & (o > 0);
    real below_transmission = principled_below_transmission(l, fresnel);
    real visible = facet_density(l.facets, h) * facet_masking(l.facets, wi);
    real seen = visible * facet_masking(l.facets, wo);
    BsdfValue v;
    // Without a boundary there is no reflection, of metal neither.
    v.f = v3_scale(principled_reflectance(b, l, fresnel, i), (reflects & (fresnel > 0)) ? R(0.25) * seen : (real)(0));
    v.pdf = reflects ? R(0.25) * (1 - below_transmission) * visible : (real)(0);
    if (PRINCIPLED_HAS(spec_trans)) {
        // Walter et al. 2007, equations 17 and 21, with facets as they are seen from wi. By Snell's law 1 / (i + eta o)
        // is (i - eta o) / (1 - eta^2), in which nearly equal indices leave no difference of nearly equal numbers.
        mask transmits = l.glass > 0 & wo.z < 0 & i > 0 & o < 0;
        real crossing = i * -o * square((i - l.boundary.eta * o) / l.boundary.step);
        v3 color = v3_of(sqrt(b.base_color.x), sqrt(b.base_color.y), sqrt(b.base_color.z));
        v.f = v3_mad(color, transmits ? l.glass * (1 - fresnel) * seen * crossing : (real)(0), v.f);
        real density = (below_transmission - l.below_coat) * visible * crossing * square(l.boundary.eta);
        v.pdf = v.pdf + (transmits ? density : (real)(0));
    }
    if (PRINCIPLED_HAS(clearcoat)) {
        MicrofacetDistribution shadows = disney_ggx((real)(COAT_SHADOWING_ALPHA), (real)(COAT_SHADOWING_ALPHA));
        real d = gtr1(h, coat_alpha(b)), weight = schlick_weight_at(i, b.eta);
        real shadowing = facet_masking(shadows, wi) * wi.z * facet_masking(shadows, wo) * wo.z;
        real f = l.coat * (weight + (1 - weight) * COAT_AT_NORMAL) * d * shadowing;
        v.f = v3_add(v.f, v3_all((reflects & l.front) ? f : (real)(0)));
        v.pdf = v.pdf + (reflects ? (l.below_coat - l.below_base) * d * h.z / (4 * o) : (real)(0));
    }
    mask above = l.front & (wo.z > 0);
    real base = above ? l.diffuse * INV_PI * disney_diffuse(b.roughness, b.flatness, wi.z, wo.z, o) : (real)(0);
    v.f = v3_mad(b.base_color, base, v.f);
    if (PRINCIPLED_HAS(sheen)) {
        v3 sheen = disney_sheen(b.base_color, (1 - b.metallic) * b.sheen, b.sheen_tint, o);
        v.f = v3_add(v.f, v3_pick(above & (l.diffuse > 0), sheen, v3_all((real)(0)))); // Mitsuba's goes with the base
    }
    v.pdf = v.pdf + (above ? l.below_base * wo.z * INV_PI : (real)(0));
    return v;
}

// The same for any two directions.
static BsdfValue principled_between(principled_bsdf b, v3 wi, v3 wo) {
    PrincipledLobes l = principled_lobes(b, wi);
    if (PRINCIPLED_HAS(spec_trans)) {
        wo = v3_pick(l.front, wo, v3_neg(wo));
        wi = v3_pick(l.front, wi, v3_neg(wi));
    }
    v3 h = v3_add(wi, wo);
    if (PRINCIPLED_HAS(spec_trans)) {
        h = v3_pick(wo.z < 0, v3_mad(wo, l.boundary.eta, wi), h);
        h = v3_scale(h, h.z < 0 ? (real)(-1) : (real)(1));
    }
    h = v3_normalize(h);
    return principled_value(b, l, wi, wo, h, principled_facet_fresnel(l, v3_dot(wi, h)));
}

static v3 principled_eval(principled_bsdf b, v3 wi, v3 wo) { return principled_between(b, wi, wo).f; }

static real principled_pdf(principled_bsdf b, v3 wi, v3 wo) { return principled_between(b, wi, wo).pdf; }

static BsdfSample principled_sample(principled_bsdf b, v3 wi, v2 u, real lobe) {
    PrincipledLobes l = principled_lobes(b, wi);
    wi = v3_pick(l.front, wi, v3_neg(wi));
    v3 h = facet_sample(l.facets, wi, u);
    real cosine = v3_dot(wi, h), fresnel = principled_facet_fresnel(l, cosine);
    mask based = lobe < l.below_base, coated = NO_LANES;
    mask transmits = !based & (lobe >= l.below_coat) & (lobe < principled_below_transmission(l, fresnel));
    if (PRINCIPLED_HAS(clearcoat)) {
        coated = !based & (lobe < l.below_coat);
        h = v3_pick(coated, square_to_gtr1(u, coat_alpha(b)), h);
        cosine = v3_dot(wi, h);
    }
    v3 wo = v3_sub(v3_scale(h, 2 * cosine), wi);
    if (PRINCIPLED_HAS(spec_trans)) {
        real far_cosine = refracted_cosine(1 - square(cosine), l.boundary);
        v3 refracted = v3_mad(h, cosine * l.boundary.inverse_eta - far_cosine, v3_scale(wi, -l.boundary.inverse_eta));
        wo = v3_pick(transmits, refracted, wo);
    }
    wo = v3_pick(based, square_to_cosine_hemisphere(u), wo);
    h = v3_pick(based, v3_normalize(v3_add(wi, wo)), h);
    // The facet that was drawn keeps its own, by which it was drawn.
    if (PRINCIPLED_HAS(clearcoat)) based = based | coated;
    fresnel = based ? principled_facet_fresnel(l, v3_dot(wi, h)) : fresnel;
    BsdfValue v = principled_value(b, l, wi, wo, h, fresnel);
    mask kept = (v.pdf > 0) & (transmits ? wo.z < 0 : wo.z > 0);
    real eta = transmits ? l.boundary.eta : (real)(1);
    v3 weight = v3_pick(kept, v3_scale(v.f, fabs(wo.z) * square(eta) / v.pdf), v3_all((real)(0)));
    return bsdf_sample_of(v3_pick(l.front, wo, v3_neg(wo)), weight, kept ? v.pdf : (real)(0), eta, NO_LANES);
}
