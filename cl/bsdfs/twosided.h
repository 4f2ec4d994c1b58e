// The parameters of BSDF twosided: a BSDF for each side of a surface (bsdfs/twosided.cl).
#ifndef OPAL_BSDF_TWOSIDED_H
#define OPAL_BSDF_TWOSIDED_H

#include "shared/parameters.h"

#define OPAL_BSDF_twosided(PARAMETER) \
    PARAMETER(BSDF, base, "", 0, ANY, "the BSDF of the front, and of the back where no other is given") \
    PARAMETER(BSDF, back, "", 0, ANY, "the BSDF of the back")

#endif
