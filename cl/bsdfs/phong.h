// The parameters of BSDF phong: the modified Phong model (bsdfs/phong.cl).
#ifndef OPAL_BSDF_PHONG_H
#define OPAL_BSDF_PHONG_H

#include "shared/parameters.h"

#define OPAL_BSDF_phong(PARAMETER) \
    PARAMETER(COLOR, kd, "kd", 0.5, AT_LEAST(0), "diffuse reflectance") \
    PARAMETER(COLOR, ks, "ks", 0.5, AT_LEAST(0), "specular reflectance") \
    PARAMETER(NUMBER, pd, "pd", 0.5, BETWEEN(0, 1), "share of the diffuse part, and the probability to draw from it") \
    PARAMETER(NUMBER, n, "n", 20, AT_LEAST(0), "exponent of the lobe")

#endif
