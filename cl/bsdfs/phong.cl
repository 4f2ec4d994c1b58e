// phong: the modified Phong model, one-sided (Lafortune and Willems 1994).
//   <bsdf type="phong"> <color name="kd" value="0.5"/> <color name="ks" value="0.5"/>
//     <float name="pd" value="0.5"/> <float name="n" value="20"/> </bsdf>
// f = kd pd / pi + ks (1 - pd) (n + 2)/(2 pi) cos^n a, with a between wo and the mirrored wi.
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"

// The probability to draw from the diffuse part: pd as random numbers have it.
static real phong_base_chance(phong_bsdf b) { return drawn_probability(b.pd); }

// Density at wo of the lobe alone, solid angle measure.
static real phong_lobe(phong_bsdf b, v3 wi, v3 wo) {
    return square_to_phong_lobe_pdf(to_local(frame_of(reflect_z(wi)), wo), b.n);
}

static v3 phong_eval(phong_bsdf b, v3 wi, v3 wo) {
    mask above = wi.z > 0 & wo.z > 0;
    real specular = (1 - b.pd) * (b.n + 2) / (b.n + 1) * phong_lobe(b, wi, wo);
    v3 f = v3_add(v3_scale(b.kd, b.pd * INV_PI), v3_scale(b.ks, specular));
    return v3_pick(above, f, v3_all((real)(0)));
}

// The density of phong_sample, which may draw wo below the surface; there the sample has weight 0.
static real phong_pdf(phong_bsdf b, v3 wi, v3 wo) {
    real base_chance = phong_base_chance(b);
    real density = base_chance * square_to_cosine_hemisphere_pdf(wo) + (1 - base_chance) * phong_lobe(b, wi, wo);
    return wi.z > 0 ? density : (real)(0);
}

static BsdfSample phong_sample(phong_bsdf b, v3 wi, v2 u, real lobe) {
    real base_chance = phong_base_chance(b);
    mask diffuse = lobe < base_chance;
    Frame mirrored = frame_of(reflect_z(wi));
    v3 wo = v3_pick(diffuse, square_to_cosine_hemisphere(u), to_world(mirrored, square_to_phong_lobe(u, b.n)));
    // f cos / pdf with the larger of both densities divided out, because either alone may overflow or vanish.
    real base = square_to_cosine_hemisphere_pdf(wo), peak = phong_lobe(b, wi, wo);
    real larger = real_max(base, peak);
    real of_base = base / larger, of_peak = peak / larger;
    real density = base_chance * of_base + (1 - base_chance) * of_peak;
    v3 specular = v3_scale(b.ks, (1 - b.pd) * (b.n + 2) / (b.n + 1) * of_peak * wo.z);
    v3 f_cos = v3_add(v3_scale(b.kd, b.pd * of_base), specular);
    mask kept = wi.z > 0 & wo.z > 0 & density > 0;
    real pdf = wi.z > 0 ? base_chance * base + (1 - base_chance) * peak : (real)(0);
    v3 weight = v3_pick(kept, v3_scale(f_cos, 1 / density), v3_all((real)(0)));
    return bsdf_sample_of(wo, weight, pdf, (real)(1), NO_LANES);
}
