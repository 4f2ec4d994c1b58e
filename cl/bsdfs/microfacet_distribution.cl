// microfacet_distribution: the normals of the facets of a rough surface, by Beckmann's or the GGX distribution, with a
// roughness for each of two directions, and which of them Smith's model shows and draws.
//   D     Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces", eq. 25 and 33; anisotropic as
//         in Heitz 2014, "Understanding the Masking-Shadowing Function", appendix A
//   G1    of GGX Heitz 2014, eq. 72; of Beckmann the rational fit of Walter et al. 2007, section 5.2, as Mitsuba has it
// Formulas are in slopes, x / z and y / z, and in homogeneous coordinates, so that nothing cancels at any roughness.
#include "bsdfs/microfacet_distribution.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"

typedef struct {
    real alpha_u, alpha_v; // roughness along the frame's s and t, above 0
    mask ggx;              // the distribution is GGX, else Beckmann's
    mask visible;          // facet_sample draws of the facets that are visible, else of all
} MicrofacetDistribution;

// The lanes whose facets are GGX's, by the parameter; a constant where the kernel's materials have one distribution.
static mask facets_are_ggx(mask ggx) {
    if (!OPAL_HAS_ggx) return NO_LANES;
    return OPAL_HAS_beckmann ? ggx : ALL_LANES;
}

// The distribution of parameters (microfacet_distribution.h). A kernel whose materials all draw visible facets has that
// way alone.
static MicrofacetDistribution facets_of(real alpha_u, real alpha_v, mask ggx, mask visible) {
    MicrofacetDistribution m = {real_max(alpha_u, (real)(LEAST_ALPHA)), real_max(alpha_v, (real)(LEAST_ALPHA)),
                                facets_are_ggx(ggx), visible};
    if (!OPAL_HAS_all_facets) m.visible = ALL_LANES;
    return m;
}

// D(h): the area of the facets around normal h per solid angle and area of the surface, 1/sr.
static real facet_density(MicrofacetDistribution m, v3 h) {
    real slope2 = square(h.x / m.alpha_u) + square(h.y / m.alpha_v), cos2 = square(h.z);
    real peak = INV_PI / (m.alpha_u * m.alpha_v);
    real ggx = peak * square(1 / (slope2 + cos2));
    real thinning = exp(-slope2 / cos2);
    real beckmann = thinning > 0 ? thinning * peak * square(1 / cos2) : (real)(0);
    return h.z > 0 ? (m.ggx ? ggx : beckmann) : (real)(0);
}

// The sine of direction w, its x and y scaled by the roughness: that of a surface of roughness 1, times a common factor
// with w.z.
static real stretched_sine(MicrofacetDistribution m, v3 w) {
    return sqrt(square(m.alpha_u * w.x) + square(m.alpha_v * w.y));
}

// Smith's G1(w) / |cos w|: the share of the facets that is visible from w, over the cosine, which it is divided by.
static real facet_masking(MicrofacetDistribution m, v3 w) {
    real s = stretched_sine(m, w), c = fabs(w.z);
    real ggx = 2 / (c + sqrt(c * c + s * s));
    // Walter's a = c / s is multiplied out, as s is 0 at the pole.
    real rational = (R(3.535) * s + R(2.181) * c) / (s * s + c * (R(2.276) * s + R(2.577) * c));
    real beckmann = c < R(1.6) * s ? rational : 1 / c;
    return m.ggx ? ggx : beckmann;
}

// Twice the area of Beckmann's visible facets, projected along a direction of cosine c, sine s and cotangent t, for
// roughness 1. Facets of slope x along it contribute (c - s x) exp(-x^2) / sqrt(pi), for x < t. -s x is odd, so that it
// leaves its part of x < -t alone.
typedef struct {
    real cotangent;
    real body, tail; // c (1 + erf t) and s exp(-t^2) / sqrt(pi)
} BeckmannArea;

// Cosine c and sine s may have a common factor, which the areas then have too.
static BeckmannArea beckmann_area(real c, real s) {
    const real steepest = R(16.0); // from here on erf is 1 and the tail 0 in double precision
    real t = c / real_max(s, c / steepest), e = exp(-t * t);
    // erf by Abramowitz and Stegun, 7.1.26, to 1.5e-7.
    real k = 1 / (1 + R(0.3275911) * t);
    real poly = mul_add(k, mul_add(k, (real)(R(1.061405429)), (real)(R(-1.453152027))), (real)(R(1.421413741)));
    poly = k * mul_add(k, mul_add(k, poly, (real)(R(-0.284496736))), (real)(R(0.254829592)));
    BeckmannArea area = {t, c * (2 - poly * e), s * e * R(0.56418958354775628695)};
    return area;
}

// The density of facet_sample at h, over D(h) |wi.h|. Of visible facets it is 1 over their projected area: exactly that
// and not facet_masking's fit, which is off by up to 0.3 % for Beckmann, or the density would not integrate to 1.
static real facet_chance(MicrofacetDistribution m, v3 wi, v3 h) {
    BeckmannArea area = beckmann_area(fabs(wi.z), stretched_sine(m, wi));
    real visible = m.ggx ? facet_masking(m, wi) : 2 / (area.body + area.tail);
    return m.visible ? visible : h.z / fabs(v3_dot(wi, h));
}

// The number whose error function is q, given 1 + q and 1 - q, both above 0, to 4e-7 of it (Giles 2012, "Approximating
// the erfinv Function").
static real inverse_erf(real one_plus_q, real one_minus_q) {
    real w = -log(one_plus_q * one_minus_q), a = w - R(2.5), b = sqrt(w) - 3;
    real middle = mul_add(a, (real)(R(2.81022636e-08)), (real)(R(3.43273939e-07)));
    middle = mul_add(a, mul_add(a, middle, (real)(R(-3.5233877e-06))), (real)(R(-4.39150654e-06)));
    middle = mul_add(a, mul_add(a, middle, (real)(R(0.00021858087))), (real)(R(-0.00125372503)));
    middle = mul_add(a, mul_add(a, mul_add(a, middle, (real)(R(-0.00417768164))), (real)(R(0.246640727))),
                     (real)(R(1.50140941)));
    real ends = mul_add(b, (real)(R(-0.000200214257)), (real)(R(0.000100950558)));
    ends = mul_add(b, mul_add(b, ends, (real)(R(0.00134934322))), (real)(R(-0.00367342844)));
    ends = mul_add(b, mul_add(b, ends, (real)(R(0.00573950773))), (real)(R(-0.0076224613)));
    ends = mul_add(b, mul_add(b, mul_add(b, ends, (real)(R(0.00943887047))), (real)(R(1.00167406))),
                   (real)(R(2.83297682)));
    return (w < 5 ? middle : ends) * (R(0.5) * (one_plus_q - one_minus_q));
}

// A visible normal of GGX of roughness 1, not of unit length: the sum of wi and a point of the spherical cap that it
// sees (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps"). The heights above and below the
// point, and that of the sum, are multiplied out. wi: unit
static v3 ggx_visible_normal(v3 wi, v2 u) {
    real height = 1 + wi.z, lowered = u.y * height, kept = (1 - u.y) * height;
    real raised = sin2_theta(wi) / height + kept; // 1 + z of the point, where 1 - z is `lowered`
    real sine = sqrt(lowered * raised);
    v2 cs = cos_sin_2pi(u.x);
    return v3_of(mul_add(sine, cs.x, wi.x), mul_add(sine, cs.y, wi.y), kept);
}

// The same of Beckmann: slope x along wi has the density max(0, c - s x) exp(-x^2), slope y across exp(-y^2).
// x is drawn in closed form, by the parts of BeckmannArea: from a tail below -t, by its logarithm; or from the Gaussian
// cut off at t, by the inverse error function, after which a share x / t of the positive ones changes sign, which makes
// its density there the right one. u.y decides that and is then stretched over the cases that it left.
static v3 beckmann_visible_normal(v3 wi, v2 u) {
    const real most = 1 - GRID_STEP; // of random numbers
    real s = sqrt(sin2_theta(wi));
    BeckmannArea area = beckmann_area(wi.z, s);
    real t = area.cotangent, whole = area.body + area.tail, at = u.x * whole;
    mask in_tail = at < area.tail;
    // 0 stands for the middle of its cell of the random numbers' grid.
    real one_plus_q = real_max(at - area.tail, R(0.5) * GRID_STEP * whole) / wi.z;
    real x = inverse_erf(one_plus_q, real_max(2 - one_plus_q, (real)(GRID_STEP)));
    real turning = in_tail ? (real)(0) : real_min(real_max(x, (real)(0)) * s / wi.z, (real)(1));
    mask turns = u.y < turning;
    real v = turns ? u.y / turning : (u.y - turning) / (1 - turning);
    real y = inverse_erf(real_max(2 * v, (real)(GRID_STEP)), real_max(2 - 2 * v, (real)(GRID_STEP)));
    real tail = -sqrt(t * t - log1p(-real_min(at / area.tail, most)));
    x = in_tail ? tail : (turns ? -x : x);
    mask upright = s > 0;
    real along_x = upright ? wi.x / s : (real)(1), along_y = upright ? wi.y / s : (real)(0);
    return v3_of(along_y * y - along_x * x, -along_y * x - along_x * y, (real)(1));
}

// Draws the normal of a facet; wi: on the normals' side, wi.z > 0; used for visible ones.
static v3 facet_sample(MicrofacetDistribution m, v3 wi, v2 u) {
    v3 stretched = v3_normalize(v3_of(m.alpha_u * wi.x, m.alpha_v * wi.y, wi.z));
    v3 visible = v3_pick(m.ggx, ggx_visible_normal(stretched, u), beckmann_visible_normal(stretched, u));
    real slope = sqrt(m.ggx ? u.x / (1 - u.x) : -log1p(-u.x));
    v3 any = direction_of((real)(1), slope, u.y);
    v3 h = v3_pick(m.visible, visible, any);
    return v3_normalize(v3_of(m.alpha_u * h.x, m.alpha_v * h.y, h.z));
}
