// The parameters of BSDF twosided: one BSDF on both sides of a surface (bsdfs/twosided.cl).
#ifndef OPAL_BSDF_TWOSIDED_H
#define OPAL_BSDF_TWOSIDED_H

#include "shared/parameters.h"

#define OPAL_BSDF_twosided(PARAMETER) \
    PARAMETER(BSDF, base, "", 0, ANY, "the BSDF of both sides")

#endif
