// The parameters of BSDF roughdielectric: a rough boundary between two transparent media (bsdfs/roughdielectric.cl).
#ifndef OPAL_BSDF_ROUGHDIELECTRIC_H
#define OPAL_BSDF_ROUGHDIELECTRIC_H

#include "bsdfs/dielectric.h"
#include "bsdfs/microfacet_distribution.h"
#include "shared/parameters.h"

#define OPAL_BSDF_roughdielectric(PARAMETER) OPAL_BSDF_dielectric(PARAMETER) OPAL_FACETS(PARAMETER)

#endif
