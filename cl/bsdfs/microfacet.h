// The parameters of BSDF microfacet: a rough dielectric coat over a diffuse base (bsdfs/microfacet.cl).
#ifndef OPAL_BSDF_MICROFACET_H
#define OPAL_BSDF_MICROFACET_H

#include "shared/parameters.h"

#define OPAL_BSDF_microfacet(PARAMETER) \
    PARAMETER(NUMBER, alpha, "alpha", 0.1, AT_LEAST(0), "roughness (Beckmann: root mean square slope); 0: a mirror") \
    PARAMETER(NUMBER, int_ior, "intIOR", 1.5046, ABOVE(0), "index of refraction of the coat") \
    PARAMETER(NUMBER, ext_ior, "extIOR", 1.000277, ABOVE(0), "index of refraction outside") \
    PARAMETER(COLOR, kd, "kd", 0.5, BETWEEN(0, 1), "diffuse reflectance; the coat gets 1 - max(kd)") \
    PARAMETER(FLAG, ggx, "ggx", false, ANY, "the distribution of the facets is GGX, else Beckmann's")

// Below this alpha the coat is a mirror: its lobe is narrower than the rounding of directions in floats, 2^-24.
#define MICROFACET_MIRROR_ALPHA 6e-8f

#endif
