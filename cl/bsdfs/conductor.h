// The parameters of BSDF conductor: a smooth metal (bsdfs/conductor.cl).
#ifndef OPAL_BSDF_CONDUCTOR_H
#define OPAL_BSDF_CONDUCTOR_H

#include "shared/parameters.h"

// Those of every metal: its complex index of refraction over that outside, eta - i k.
#define OPAL_METAL(PARAMETER) \
    PARAMETER(COLOR, eta, "eta", 0, AT_LEAST(0), "index of refraction of the metal, real part") \
    PARAMETER(COLOR, k, "k", 1, AT_LEAST(0), "the same, imaginary part: how it absorbs") \
    PARAMETER(COLOR, specular_reflectance, "specular_reflectance", 1, BETWEEN(0, 1), "factor of what it reflects")

#define OPAL_BSDF_conductor(PARAMETER) OPAL_METAL(PARAMETER)

#endif
