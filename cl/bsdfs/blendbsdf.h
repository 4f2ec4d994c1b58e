// The parameters of BSDF blendbsdf: two BSDFs in shares of 1 (bsdfs/blendbsdf.cl).
#ifndef OPAL_BSDF_BLENDBSDF_H
#define OPAL_BSDF_BLENDBSDF_H

#include "shared/parameters.h"

#define OPAL_BSDF_blendbsdf(PARAMETER) \
    PARAMETER(NUMBER, weight, "weight", 0.5, ANY, "share of the second BSDF, clamped to [0, 1]") \
    PARAMETER(BSDF, first, "", 0, ANY, "the BSDF that has the rest") \
    PARAMETER(BSDF, second, "", 0, ANY, "the second BSDF")

#endif
