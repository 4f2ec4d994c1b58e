// principledthin: Disney's material of a thin sheet as Mitsuba 3 has it, the same on both sides (bsdfs/disney.cl names
// the papers).
//   <bsdf type="principledthin"> <float name="specTrans" value="0.7"/> <float name="diffTrans" value="1"/> ... </bsdf>
// A specular part reflects and transmits without bending: transmitted light is reflected light on the other side, by
// facets whose roughness is that of a slab (2015, section 5.3). A diffuse part, with sheen, does both too.
#include "bsdfs/disney.cl"
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "bsdfs/microfacet_distribution.cl"
#include "bsdfs/principledthin.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"

#define THIN_PLACE(type, name, xml, initial, range, meaning) THIN_##name,
enum { OPAL_BSDF_principledthin(THIN_PLACE) };
// As PRINCIPLED_HAS.
#define THIN_HAS(name) (OPAL_NONZERO_bsdf_principledthin >> THIN_##name & 1)

// Random numbers below these draw a lobe: reflection by facets, their transmission, diffuse reflection; its
// transmission is the rest.
typedef struct {
    real reflection, transmission, base;
} ThinLobes;

static ThinLobes thin_lobes(principledthin_bsdf b) {
    ThinLobes below;
    below.reflection = drawn_probability(R(0.5) * b.spec_trans);
    below.transmission = drawn_probability(b.spec_trans);
    below.base = drawn_probability(b.spec_trans + (1 - b.spec_trans) * (1 - R(0.5) * b.diff_trans));
    return below;
}

// The facets for reflected or transmitted light (2015, section 5.3).
static MicrofacetDistribution thin_facets(principledthin_bsdf b, mask reflects) {
    real slab = R(0.65) * b.eta - R(0.35);
    return disney_facets(b.roughness * (reflects ? (real)(1) : slab), b.anisotropic);
}

// Whether a facet takes light between wi, wi.z > 0, and wo. Mitsuba asks that the true wo lies on its side of the
// facet, though facets mirror; and so some light is lost, and more of it one way than the other.
static mask thin_facet_is_met(v3 wi, v3 wo, v3 h) {
    real side = v3_dot(wo, h);
    return (v3_dot(wi, h) > 0) & (wo.z > 0 ? side > 0 : side < 0);
}

// All lobes between wi, wi.z > 0, and wo. h: the half vector of wi and of wo as reflected light
static BsdfValue thin_value(principledthin_bsdf b, v3 wi, v3 wo, v3 h) {
    ThinLobes below = thin_lobes(b);
    mask reflects = wo.z > 0, transmits = wo.z < 0;
    real reflected_base = (1 - b.spec_trans) * (1 - R(0.5) * b.diff_trans);
    real difference = v3_dot(h, wo);
    real base = INV_PI * reflected_base * disney_diffuse(b.roughness, b.flatness, wi.z, fabs(wo.z), difference);
    BsdfValue v = {v3_scale(b.base_color, reflects ? base : (real)(0)),
                   reflects ? (below.base - below.transmission) * wo.z * INV_PI : (real)(0)};
    if (THIN_HAS(sheen)) {
        v3 sheen = disney_sheen(b.base_color, reflected_base * b.sheen, b.sheen_tint, difference);
        v.f = v3_add(v.f, v3_pick(reflects, sheen, v3_all((real)(0))));
    }
    if (THIN_HAS(diff_trans)) {
        real passing = (1 - b.spec_trans) * R(0.5) * b.diff_trans * INV_PI;
        v.f = v3_mad(b.base_color, transmits ? passing : (real)(0), v.f);
        v.pdf = v.pdf + (transmits ? (1 - below.base) * -wo.z * INV_PI : (real)(0));
    }
    if (THIN_HAS(spec_trans)) {
        real i = v3_dot(wi, h);
        MicrofacetDistribution facets = thin_facets(b, reflects);
        real visible = facet_density(facets, h) * facet_masking(facets, wi);
        mask met = thin_facet_is_met(wi, wo, h);
        real seen = met ? R(0.25) * b.spec_trans * visible * facet_masking(facets, wo) : (real)(0);
        real fresnel = fresnel_dielectric(i, real_max(1 - square(i), (real)(0)), boundary_of((real)(1), b.eta));
        v3 reflectance = disney_fresnel(fresnel, b.base_color, b.spec_tint, i, b.eta);
        v.f = v3_add(v.f, v3_scale(v3_pick(reflects, reflectance, v3_scale(b.base_color, 1 - fresnel)), seen));
        real chance = reflects ? below.reflection : below.transmission - below.reflection;
        v.pdf = v.pdf + (met ? R(0.25) * chance * visible : (real)(0)); // wo as reflected light has the cosine i too
    }
    return v;
}

static v3 thin_reflected(v3 wo) { return v3_of(wo.x, wo.y, fabs(wo.z)); }

// The same for any two directions.
static BsdfValue thin_between(principledthin_bsdf b, v3 wi, v3 wo) {
    mask front = wi.z > 0;
    wi = v3_pick(front, wi, v3_neg(wi));
    wo = v3_pick(front, wo, v3_neg(wo));
    BsdfValue v = thin_value(b, wi, wo, v3_normalize(v3_add(wi, thin_reflected(wo))));
    v.f = v3_pick(wi.z > 0, v.f, v3_all((real)(0)));
    v.pdf = wi.z > 0 ? v.pdf : (real)(0);
    return v;
}

static v3 principledthin_eval(principledthin_bsdf b, v3 wi, v3 wo) { return thin_between(b, wi, wo).f; }

static real principledthin_pdf(principledthin_bsdf b, v3 wi, v3 wo) { return thin_between(b, wi, wo).pdf; }

static BsdfSample principledthin_sample(principledthin_bsdf b, v3 wi, v2 u, real lobe) {
    ThinLobes below = thin_lobes(b);
    mask front = wi.z > 0, faceted = NO_LANES, reflects = ALL_LANES;
    wi = v3_pick(front, wi, v3_neg(wi));
    v3 wo = square_to_cosine_hemisphere(u); // as reflected light
    v3 h = v3_normalize(v3_add(wi, wo));
    if (THIN_HAS(diff_trans)) reflects = lobe < below.base;
    if (THIN_HAS(spec_trans)) {
        faceted = lobe < below.transmission;
        reflects = (lobe < below.reflection) | (reflects & !faceted);
        v3 facet = facet_sample(thin_facets(b, reflects), wi, u);
        wo = v3_pick(faceted, v3_sub(v3_scale(facet, 2 * v3_dot(wi, facet)), wi), wo);
        h = v3_pick(faceted, facet, h);
    }
    mask kept = (wi.z > 0) & (wo.z > 0);
    wo.z = reflects ? wo.z : -wo.z;
    BsdfValue v = thin_value(b, wi, wo, h);
    kept = kept & (v.pdf > 0) & (!faceted | thin_facet_is_met(wi, wo, h));
    v3 weight = v3_pick(kept, v3_scale(v.f, fabs(wo.z) / v.pdf), v3_all((real)(0)));
    return bsdf_sample_of(v3_pick(front, wo, v3_neg(wo)), weight, kept ? v.pdf : (real)(0), (real)(1), NO_LANES);
}
