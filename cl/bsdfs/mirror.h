// The parameters of BSDF mirror: a perfect one-sided mirror (bsdfs/mirror.cl).
#ifndef OPAL_BSDF_MIRROR_H
#define OPAL_BSDF_MIRROR_H

#include "shared/parameters.h"

#define OPAL_BSDF_mirror(PARAMETER)

#endif
