// roughdielectric: a boundary of rough facets between two transparent media, two-sided (Walter et al. 2007,
// "Microfacet Models for Refraction through Rough Surfaces").
//   <bsdf type="roughdielectric"> <float name="alpha" value="0.2"/> <float name="intIOR" value="1.5046"/> </bsdf>
// With c = |wi.h|, c' = |wo.h| and eta the index of wo's side over that of wi's side (eq. 20 and 21, of radiance, which
// eq. 21 leaves to divide by eta^2):
//   reflected     f = F D(h) G1(wi) G1(wo) / (4 cos_i cos_o),  h along wi + wo
//   transmitted   f = (1 - F) D(h) G1(wi) G1(wo) c c' / (cos_i cos_o (c - eta c')^2),  h along wi + eta wo
// By Snell's law c^2 - eta^2 c'^2 = 1 - eta^2, and so 1 / (c - eta c') = (c + eta c') / (1 - eta^2), in which nearly
// equal indices leave no difference of nearly equal numbers.
#include "bsdfs/dielectric.cl"
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "bsdfs/microfacet_distribution.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"

// The facets that directions are drawn by. All facets are drawn rougher than they are, or weights would be large at
// grazing angles (section 5.3). cosine: of wi
static MicrofacetDistribution roughdielectric_drawn(MicrofacetDistribution m, real cosine) {
    if (!OPAL_HAS_all_facets) return m;
    real widening = m.visible ? (real)(1) : R(1.2) - R(0.2) * sqrt(cosine);
    m.alpha_u = m.alpha_u * widening;
    m.alpha_v = m.alpha_v * widening;
    return m;
}

// A facet that takes light between wi, which has been turned to the normal's side, and another direction.
typedef struct {
    Boundary boundary;
    v3 h;                   // its normal, on wi's side
    real cosine, refracted; // c, and c' of the refracted direction
    real fresnel;           // F
    real crossing;          // c c' / (c - eta c')^2
} GlassFacet;

static GlassFacet glass_facet(Boundary boundary, v3 wi, v3 h) {
    GlassFacet facet;
    facet.boundary = boundary;
    facet.h = h;
    facet.cosine = v3_dot(wi, h);
    real sin2 = real_max(1 - square(facet.cosine), (real)(0));
    facet.refracted = refracted_cosine(sin2, boundary);
    facet.fresnel = fresnel_dielectric(fabs(facet.cosine), sin2, boundary);
    real inverse = mul_add(boundary.eta, facet.refracted, facet.cosine) / boundary.step;
    facet.crossing = facet.cosine * facet.refracted * square(inverse);
    return facet;
}

static Boundary roughdielectric_boundary(roughdielectric_bsdf b, v3 wi) {
    mask outside = wi.z > 0;
    return boundary_of(outside ? b.ext_ior : b.int_ior, outside ? b.int_ior : b.ext_ior);
}

static MicrofacetDistribution roughdielectric_facets(roughdielectric_bsdf b) {
    return facets_of(b.alpha_u, b.alpha_v, b.ggx, b.sample_visible);
}

// Both directions seen from wi's side: its z above 0.
static v3 from_side_of(v3 wi, v3 w) { return v3_of(w.x, w.y, turned_as(w.z, wi.z)); }

// The facet that would take light between wi and wo, turned to the normal's side. Sets *possible to the lanes where
// both see the sides of it that they must.
static GlassFacet facet_between(Boundary boundary, v3 wi, v3 wo, mask *possible) {
    mask reflects = wo.z > 0;
    v3 h = v3_normalize(v3_mad(wo, reflects ? (real)(1) : boundary.eta, wi));
    h = v3_of(turned_as(h.x, h.z), turned_as(h.y, h.z), fabs(h.z));
    GlassFacet facet = glass_facet(boundary, wi, h);
    real other = v3_dot(wo, h);
    *possible = facet.cosine > 0 & (reflects ? other : -other) > 0;
    return facet;
}

static v3 roughdielectric_eval(roughdielectric_bsdf b, v3 wi, v3 wo) {
    MicrofacetDistribution m = roughdielectric_facets(b);
    Boundary boundary = roughdielectric_boundary(b, wi);
    wo = from_side_of(wi, wo);
    wi = from_side_of(wi, wi);
    mask possible, reflects = wo.z > 0;
    GlassFacet facet = facet_between(boundary, wi, wo, &possible);
    real facets = facet_density(m, facet.h) * facet_masking(m, wi) * facet_masking(m, wo);
    real part = reflects ? R(0.25) * facet.fresnel : (1 - facet.fresnel) * facet.crossing;
    v3 f = glass_weight(reflects, facets * part, b.specular_reflectance, b.specular_transmittance);
    return v3_pick(possible, f, v3_all((real)(0)));
}

static real roughdielectric_pdf(roughdielectric_bsdf b, v3 wi, v3 wo) {
    Boundary boundary = roughdielectric_boundary(b, wi);
    wo = from_side_of(wi, wo);
    wi = from_side_of(wi, wi);
    MicrofacetDistribution m = roughdielectric_drawn(roughdielectric_facets(b), wi.z);
    mask possible;
    GlassFacet facet = facet_between(boundary, wi, wo, &possible);
    real reflection = drawn_probability(facet.fresnel);
    real part = wo.z > 0 ? R(0.25) * reflection : (1 - reflection) * facet.crossing * square(boundary.eta);
    real density = facet_density(m, facet.h) * facet_chance(m, wi, facet.h) * part;
    return possible ? density : (real)(0);
}

// As roughconductor_sample, the weight uses the facet that was drawn.
static BsdfSample roughdielectric_sample(roughdielectric_bsdf b, v3 wi, v2 u, real lobe) {
    MicrofacetDistribution m = roughdielectric_facets(b);
    Boundary boundary = roughdielectric_boundary(b, wi);
    v3 up = from_side_of(wi, wi);
    MicrofacetDistribution drawn = roughdielectric_drawn(m, up.z);
    GlassFacet facet = glass_facet(boundary, up, facet_sample(drawn, up, u));
    Choice reflection = choose(facet.fresnel, lobe);
    mask reflects = reflection.first;
    real along = reflects ? 2 * facet.cosine : mul_add(facet.cosine, boundary.inverse_eta, -facet.refracted);
    v3 wo = v3_mad(up, reflects ? (real)(-1) : -boundary.inverse_eta, v3_scale(facet.h, along));
    mask kept = up.z > 0 & facet.cosine > 0 & (reflects ? wo.z : -wo.z) > 0;
    real d = facet_density(drawn, facet.h), chance = facet_chance(drawn, up, facet.h);
    real masking = facet_masking(m, up) / chance * facet_masking(m, wo) * fabs(wo.z);
    if (OPAL_HAS_all_facets) {
        masking = masking * (facet_density(m, facet.h) / d);
        kept = kept & (d > 0); // which underflows where Beckmann's facets are rare
    }
    real weight = (reflects ? facet.fresnel : 1 - facet.fresnel) / reflection.probability * masking;
    real part = reflects ? R(0.25) : facet.crossing * square(boundary.eta);
    v3 colored = glass_weight(reflects, weight, b.specular_reflectance, b.specular_transmittance);
    return bsdf_sample_of(from_side_of(wi, wo), v3_pick(kept, colored, v3_all((real)(0))),
                          kept ? d * chance * reflection.probability * part : (real)(0),
                          reflects ? (real)(1) : boundary.eta, NO_LANES);
}
