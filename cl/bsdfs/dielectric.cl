// dielectric: a smooth boundary between two transparent media, two-sided, discrete.
//   <bsdf type="dielectric"> <float name="intIOR" value="1.5046"/> <float name="extIOR" value="1.000277"/> </bsdf>
// Reflects with the Fresnel reflectance as probability, rounded up to the random numbers' grid; else refracts by
// Snell's law, and reports eta, the index of the far side over that of the near side.
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"

// A weight times the glass's colour for what it reflects or lets through. 1 in kernels without tinted glass.
static v3 glass_weight(mask reflects, real weight, v3 reflectance, v3 transmittance) {
    if (!OPAL_HAS_tinted_glass) return v3_all(weight);
    return v3_scale(v3_pick(reflects, reflectance, transmittance), weight);
}

static v3 dielectric_eval(dielectric_bsdf b, v3 wi, v3 wo) { return v3_all((real)(0)); }

static real dielectric_pdf(dielectric_bsdf b, v3 wi, v3 wo) { return (real)(0); }

static BsdfSample dielectric_sample(dielectric_bsdf b, v3 wi, v2 u, real lobe) {
    mask outside = wi.z > 0;
    real near = outside ? b.ext_ior : b.int_ior, far = outside ? b.int_ior : b.ext_ior;
    Boundary boundary = boundary_of(near, far);
    real sin2 = sin2_theta(wi), far_cosine = refracted_cosine(sin2, boundary);
    real fresnel = fresnel_dielectric(fabs(wi.z), sin2, boundary);
    Choice reflection = choose(fresnel, lobe);
    mask reflects = reflection.first;
    v3 refracted = v3_of(-wi.x * boundary.inverse_eta, -wi.y * boundary.inverse_eta,
                         outside ? -far_cosine : far_cosine);
    real weight = (reflects ? fresnel : 1 - fresnel) / reflection.probability;
    v3 colored = glass_weight(reflects, wi.z != 0 ? weight : (real)(0), b.specular_reflectance,
                              b.specular_transmittance);
    return bsdf_sample_of(v3_pick(reflects, reflect_z(wi), refracted), colored, (real)(0),
                          reflects ? (real)(1) : boundary.eta, ALL_LANES);
}
