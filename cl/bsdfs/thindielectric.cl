// thindielectric: a pane so thin that light goes straight on, two-sided, discrete.
//   <bsdf type="thindielectric"> <float name="intIOR" value="1.5046"/> <float name="extIOR" value="1.000277"/> </bsdf>
// Light that its two boundaries of reflectance R throw to and fro within it leaves in the end: it reflects
// R + (1 - R)^2 R (1 + R^2 + ...) = 2 R / (1 + R), and the rest passes.
#include "bsdfs/dielectric.cl"
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"

static v3 thindielectric_eval(thindielectric_bsdf b, v3 wi, v3 wo) { return v3_all((real)(0)); }

static real thindielectric_pdf(thindielectric_bsdf b, v3 wi, v3 wo) { return (real)(0); }

static BsdfSample thindielectric_sample(thindielectric_bsdf b, v3 wi, v2 u, real lobe) {
    real once = fresnel_dielectric(fabs(wi.z), sin2_theta(wi), boundary_of(b.ext_ior, b.int_ior));
    real reflectance = 2 * once / (1 + once);
    Choice reflection = choose(reflectance, lobe);
    real weight = (reflection.first ? reflectance : 1 - reflectance) / reflection.probability;
    v3 colored = glass_weight(reflection.first, weight, b.specular_reflectance, b.specular_transmittance);
    BsdfSample s = bsdf_sample_of(v3_pick(reflection.first, reflect_z(wi), v3_neg(wi)), colored, (real)(0), (real)(1),
                                  ALL_LANES);
    s.passes = !reflection.first;
    return s;
}
