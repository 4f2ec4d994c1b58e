// The parameters of BSDF thindielectric: a thin pane between two smooth boundaries (bsdfs/thindielectric.cl).
#ifndef OPAL_BSDF_THINDIELECTRIC_H
#define OPAL_BSDF_THINDIELECTRIC_H

#include "bsdfs/dielectric.h"
#include "shared/parameters.h"

#define OPAL_BSDF_thindielectric(PARAMETER) OPAL_BSDF_dielectric(PARAMETER)

#endif
