// plastic: a smooth transparent coat over a diffuse base, one-sided, as Mitsuba has it. The coat reflects as a mirror.
//   <bsdf type="plastic"> <color name="diffuse_reflectance" value="0.1 0.3 0.6"/> <string name="intIOR" value="pet"/>
//     </bsdf>
// With F Fresnel's reflectance, T = 1 - F, eta the coat's index over that outside, a the base's reflectance, and R the
// part of diffuse light from the base that the boundary reflects back to it (host/flatten/plastic_boundary.h):
//   f = T(wi) T(wo) / (pi eta^2) a / (1 - a' R)
// The last factor is the sum over all ways that light goes between base and boundary (Saunderson 1942, "Calculation of
// the Color of Pigmented Plastics"). a' is a where `nonlinear`, else 1: the base colours light once.
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "bsdfs/plastic.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"
#include "parameters.cl"

// pi f of the base. transmitted: T(wi) T(wo); eta2: eta^2
static v3 plastic_base(v3 reflectance, mask nonlinear, real inside, real eta2, real transmitted) {
    v3 back = v3_pick(nonlinear, v3_scale(reflectance, inside), v3_all(inside));
    real entered = transmitted / eta2;
    return v3_of(entered * reflectance.x / (1 - back.x), entered * reflectance.y / (1 - back.y),
                 entered * reflectance.z / (1 - back.z));
}

// The probability to draw the coat, given what its boundary reflects of light from wi. Each part counts by the mean of
// its colour, as in Mitsuba, which takes the mean of a texture where this takes its value.
static real plastic_coat_chance(v3 specular, v3 diffuse, real reflected) {
    real coat = reflected * (specular.x + specular.y + specular.z);
    real base = (1 - reflected) * (diffuse.x + diffuse.y + diffuse.z);
    return coat > 0 ? coat / (coat + base) : (real)(0);
}

static real plastic_fresnel(Boundary boundary, v3 w) {
    return fresnel_dielectric(fabs(w.z), sin2_theta(w), boundary);
}

static v3 plastic_base_of(plastic_bsdf b, Boundary boundary, real transmitted) {
    return plastic_base(b.diffuse_reflectance, b.nonlinear, curve_number(b.boundary, (uints)(PLASTIC_INSIDE)),
                        square(boundary.eta), transmitted);
}

static v3 plastic_eval(plastic_bsdf b, v3 wi, v3 wo) {
    Boundary boundary = boundary_of(b.ext_ior, b.int_ior);
    real transmitted = (1 - plastic_fresnel(boundary, wi)) * (1 - plastic_fresnel(boundary, wo));
    mask above = wi.z > 0 & wo.z > 0;
    return v3_scale(plastic_base_of(b, boundary, transmitted), above ? (real)(INV_PI) : (real)(0));
}

static real plastic_pdf(plastic_bsdf b, v3 wi, v3 wo) {
    real reflected = plastic_fresnel(boundary_of(b.ext_ior, b.int_ior), wi);
    real coat = drawn_probability(plastic_coat_chance(b.specular_reflectance, b.diffuse_reflectance, reflected));
    return (wi.z > 0 & wo.z > 0) ? (1 - coat) * square_to_cosine_hemisphere_pdf(wo) : (real)(0);
}

static BsdfSample plastic_sample(plastic_bsdf b, v3 wi, v2 u, real lobe) {
    Boundary boundary = boundary_of(b.ext_ior, b.int_ior);
    real reflected = plastic_fresnel(boundary, wi);
    Choice coat = choose(plastic_coat_chance(b.specular_reflectance, b.diffuse_reflectance, reflected), lobe);
    v3 wo = v3_pick(coat.first, reflect_z(wi), square_to_cosine_hemisphere(u));
    real transmitted = (1 - reflected) * (1 - plastic_fresnel(boundary, wo));
    v3 part = v3_pick(coat.first, v3_scale(b.specular_reflectance, reflected),
                      plastic_base_of(b, boundary, transmitted));
    mask front = wi.z > 0;
    real pdf = coat.probability * square_to_cosine_hemisphere_pdf(wo);
    return bsdf_sample_of(wo, v3_scale(part, front ? 1 / coat.probability : (real)(0)),
                          (front & !coat.first) ? pdf : (real)(0), (real)(1), coat.first);
}
