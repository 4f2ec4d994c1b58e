// oren_nayar: a rough surface of diffuse facets, one-sided, by the energy-preserving model of Portsmouth, Kutz and Hill
// 2025, "EON: A Practical Energy-Preserving Rough Diffuse BRDF": the model of Oren and Nayar 1994 as Fujii improved it,
//   f_1 = albedo / pi A (1 + alpha s),  A = 1 / (1 + (1/2 - 2 / (3 pi)) alpha),
//   s = (wi.wo - cos_i cos_o) / (1 where negative, else max(cos_i, cos_o)),
// and light that facets send to each other, by the albedo E(w) that f_1 has at albedo 1, and its mean M over cosines:
//   f_2 = albedo^2 M / (1 - albedo (1 - M)) / pi (1 - E(wi)) (1 - E(wo)) / (1 - M).
// White facets so reflect all light.
//   <bsdf type="oren_nayar"> <color name="albedo" value="0.8"/> <float name="alpha" value="0.5"/> </bsdf>
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"

#define FUJII_A R(0.2877934092108062)     // 1/2 - 2 / (3 pi)
#define FUJII_MEAN R(0.07248821245692394) // 2/3 - 28 / (15 pi)

// What is lost to other facets, over alpha A: 1 - E(w) = alpha A ((1/2 - 2 / (3 pi)) - G(w) / pi), with
//   G(w) = sin (theta - sin cos) + 2/3 (tan (1 - sin^3) - sin).
// tan (1 - sin^3) is multiplied out by cos^2 = (1 - sin)(1 + sin).
static real oren_nayar_lost(v3 w) {
    real s = sqrt(sin2_theta(w)), c = w.z;
    real g = s * (atan2(s, c) - s * c) + R(2.0) / 3 * (s * c * (1 + s + s * s) / (1 + s) - s);
    return real_max(FUJII_A - INV_PI * g, (real)(0));
}

static v3 oren_nayar_eval(oren_nayar_bsdf b, v3 wi, v3 wo) {
    real a = 1 / (1 + FUJII_A * b.alpha), lost = b.alpha * a * (FUJII_A - FUJII_MEAN); // 1 - M
    real s = mul_add(wi.x, wo.x, wi.y * wo.y);
    s = s > 0 ? s / real_max(wi.z, wo.z) : s;
    real once = INV_PI * a * (1 + b.alpha * s);
    // (1 - E(wi)) (1 - E(wo)) / (1 - M), where alpha cancels once
    real again = INV_PI * b.alpha * a * oren_nayar_lost(wi) * oren_nayar_lost(wo) / (FUJII_A - FUJII_MEAN);
    v3 f = v3_of(b.albedo.x * (once + again * b.albedo.x * (1 - lost) / (1 - b.albedo.x * lost)),
                 b.albedo.y * (once + again * b.albedo.y * (1 - lost) / (1 - b.albedo.y * lost)),
                 b.albedo.z * (once + again * b.albedo.z * (1 - lost) / (1 - b.albedo.z * lost)));
    return v3_pick(wi.z > 0 & wo.z > 0, f, v3_all((real)(0)));
}

// The probability to draw uniformly: near the horizon f_1 grows as 1 / max(cos_i, cos_o), which a cosine's density does
// not follow. It is what the term of s has of f_1's albedo at grazing incidence, alpha / (2 + alpha), times 1 - cos_i.
static real oren_nayar_uniform_chance(oren_nayar_bsdf b, v3 wi) {
    return drawn_probability(b.alpha / (2 + b.alpha) * real_max(1 - wi.z, (real)(0)));
}

static real oren_nayar_pdf(oren_nayar_bsdf b, v3 wi, v3 wo) {
    real uniform_chance = oren_nayar_uniform_chance(b, wi);
    real density = uniform_chance * square_to_uniform_hemisphere_pdf(wo) +
                   (1 - uniform_chance) * square_to_cosine_hemisphere_pdf(wo);
    return (wi.z > 0 & wo.z > 0) ? density : (real)(0);
}

static BsdfSample oren_nayar_sample(oren_nayar_bsdf b, v3 wi, v2 u, real lobe) {
    mask uniformly = lobe < oren_nayar_uniform_chance(b, wi);
    v3 wo = v3_pick(uniformly, square_to_uniform_hemisphere(u), square_to_cosine_hemisphere(u));
    real pdf = oren_nayar_pdf(b, wi, wo);
    v3 weight = v3_scale(oren_nayar_eval(b, wi, wo), wo.z / (pdf > 0 ? pdf : (real)(1)));
    return bsdf_sample_of(wo, weight, pdf, (real)(1), NO_LANES);
}
