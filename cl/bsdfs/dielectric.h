// The parameters of BSDF dielectric: a smooth boundary between two transparent media (bsdfs/dielectric.cl).
#ifndef OPAL_BSDF_DIELECTRIC_H
#define OPAL_BSDF_DIELECTRIC_H

#include "shared/parameters.h"

#define OPAL_BSDF_dielectric(PARAMETER) \
    PARAMETER(NUMBER, int_ior, "intIOR", 1.5046, ABOVE(0), \
              "index of refraction on the side the normal points away from (BK7 glass)") \
    PARAMETER(NUMBER, ext_ior, "extIOR", 1.000277, ABOVE(0), \
              "index of refraction on the side the normal points to (air)") \
    PARAMETER(COLOR, specular_reflectance, "specular_reflectance", 1, BETWEEN(0, 1), "factor of what is reflected") \
    PARAMETER(COLOR, specular_transmittance, "specular_transmittance", 1, BETWEEN(0, 1), "factor of what passes")

#endif
