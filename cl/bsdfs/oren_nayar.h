// The parameters of BSDF oren_nayar: rough diffuse reflection (bsdfs/oren_nayar.cl).
#ifndef OPAL_BSDF_OREN_NAYAR_H
#define OPAL_BSDF_OREN_NAYAR_H

#include "shared/parameters.h"

#define OPAL_BSDF_oren_nayar(PARAMETER) \
    PARAMETER(COLOR, albedo, "albedo", 0.5, BETWEEN(0, 1), "reflectance of the facets") \
    PARAMETER(NUMBER, alpha, "alpha", 0.3, BETWEEN(0, 1), \
              "standard deviation of the facets' angles to the surface, radians; 0: diffuse")

#endif
