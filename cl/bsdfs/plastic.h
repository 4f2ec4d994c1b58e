// The parameters of BSDF plastic: a smooth transparent coat over a diffuse base (bsdfs/plastic.cl).
#ifndef OPAL_BSDF_PLASTIC_H
#define OPAL_BSDF_PLASTIC_H

#include "shared/parameters.h"

#define OPAL_BSDF_plastic(PARAMETER) \
    PARAMETER(COLOR, diffuse_reflectance, "diffuse_reflectance", 0.5, BETWEEN(0, 1), "reflectance of the base") \
    PARAMETER(COLOR, specular_reflectance, "specular_reflectance", 1, BETWEEN(0, 1), \
              "factor of what the coat reflects") \
    PARAMETER(NUMBER, int_ior, "intIOR", 1.49, ABOVE(0), "index of refraction of the coat (polypropylene)") \
    PARAMETER(NUMBER, ext_ior, "extIOR", 1.000277, ABOVE(0), "index of refraction outside (air)") \
    PARAMETER(FLAG, nonlinear, "nonlinear", false, ANY, \
              "light that the coat sends back to the base takes its colour again") \
    PARAMETER(CURVE, boundary, "", 0, ANY, "the coat's boundary: PLASTIC_INSIDE, of facets PLASTIC_TRANSMITTED")

// The numbers of a plastic's boundary: the part of diffuse light from the base that it reflects back; and, of facets,
// what it transmits of light at even steps of the cosine.
enum { PLASTIC_INSIDE, PLASTIC_TRANSMITTED, PLASTIC_COSINES = 64 };

#endif
