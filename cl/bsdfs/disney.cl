// disney: what the principled BSDFs share, as Mitsuba 3 has it. Burley 2012, "Physically Based Shading at Disney";
// Burley 2015, "Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering".
#include "bsdfs/fresnel.cl"
#include "bsdfs/microfacet_distribution.cl"
#include "core/lanes.cl"
#include "core/math.cl"

// f(wi, wo) without the cosine, and the density with which wo is drawn, of one BSDF.
typedef struct {
    v3 f;
    real pdf;
} BsdfValue;

// GGX facets of that alpha, of which the visible ones are drawn.
static MicrofacetDistribution disney_ggx(real alpha_u, real alpha_v) {
    MicrofacetDistribution m = {alpha_u, alpha_v, ALL_LANES, ALL_LANES};
    return m;
}

// The facets of a roughness, stretched along dp/du (2012, section 5.4). Their alpha never gets to 0.
#define DISNEY_ALPHA_LEAST R(0.001)
static MicrofacetDistribution disney_facets(real roughness, real anisotropic) {
    real alpha = square(roughness), aspect = sqrt(1 - R(0.9) * anisotropic);
    return disney_ggx(real_max(alpha / aspect, (real)(DISNEY_ALPHA_LEAST)),
                      real_max(alpha * aspect, (real)(DISNEY_ALPHA_LEAST)));
}

// (1 - cos)^5 of Schlick's Fresnel term.
static real schlick_weight(real cosine) {
    real m = real_min(real_max(1 - cosine, (real)(0)), (real)(1));
    return square(square(m)) * m;
}

// The same at incidence `cosine`, from 0 to 1, on a boundary of index eta. Towards the thinner medium it is that of the
// refracted direction.
static real schlick_weight_at(real cosine, real eta) {
    real refracted = safe_sqrt(1 - (1 - square(cosine)) / square(eta));
    return schlick_weight(eta > 1 ? cosine : refracted);
}

static v3 schlick(v3 at_normal, real weight) { return v3_mad(at_normal, 1 - weight, v3_all(weight)); }

// A colour at luminance 1; white for one that is darker than single precision divides by.
#define TINT_LEAST R(1e-30)
static v3 tint_of(v3 color) {
    real y = luminance(color);
    mask dark = y < TINT_LEAST;
    return v3_pick(dark, v3_all((real)(1)), v3_scale(color, 1 / (dark ? (real)(1) : y)));
}

// White mixed with the colour's tint.
static v3 tinted(v3 color, real share) { return v3_mad(tint_of(color), share, v3_all(1 - share)); }

// Fresnel's reflectance of the facets of a dielectric, mixed with the base's tint in Schlick's approximation (2012,
// section 5.5). exact: Fresnel's own; cosine: of incidence, from outside
static v3 disney_fresnel(real exact, v3 base_color, real spec_tint, real cosine, real eta) {
    v3 at_normal = v3_scale(tint_of(base_color), square((eta - 1) / (eta + 1)));
    v3 approximated = schlick(at_normal, schlick_weight_at(cosine, eta));
    return v3_mad(approximated, spec_tint, v3_all((1 - spec_tint) * exact));
}

// The diffuse part, pi f / base_color: Lambert's with Fresnel's darkening at grazing angles, and retro-reflection
// (2012, section 5.3; 2015, section 4), mixed by flatness with the isotropic subsurface term of Hanrahan and Krueger.
// difference: the cosine between wo and the half vector
static real disney_diffuse(real roughness, real flatness, real cos_i, real cos_o, real difference) {
    real in = schlick_weight(cos_i), out = schlick_weight(cos_o), retro = 2 * roughness * square(difference);
    real diffuse = (1 - R(0.5) * in) * (1 - R(0.5) * out) + retro * (in + out + in * out * (retro - 1));
    real grazing = R(0.5) * retro - 1;
    real subsurface = (1 + grazing * in) * (1 + grazing * out);
    real flat = R(1.25) * (subsurface * (1 / (cos_i + cos_o) - R(0.5)) + R(0.5));
    return diffuse + flatness * (flat - diffuse);
}

// The sheen, f (2012, section 5.6).
static v3 disney_sheen(v3 base_color, real sheen, real sheen_tint, real difference) {
    return v3_scale(tinted(base_color, sheen_tint), sheen * schlick_weight(fabs(difference)));
}
