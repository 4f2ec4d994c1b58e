// The parameters of BSDF mask: a surface of which light meets a share (bsdfs/mask.cl).
#ifndef OPAL_BSDF_MASK_H
#define OPAL_BSDF_MASK_H

#include "shared/parameters.h"

#define OPAL_BSDF_mask(PARAMETER) \
    PARAMETER(NUMBER, opacity, "opacity", 0.5, BETWEEN(0, 1), "the probability that light meets the surface") \
    PARAMETER(BSDF, base, "", 0, ANY, "the BSDF of the surface")

#endif
