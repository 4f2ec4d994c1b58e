// The parameters of BSDF roughconductor: a rough metal (bsdfs/roughconductor.cl).
#ifndef OPAL_BSDF_ROUGHCONDUCTOR_H
#define OPAL_BSDF_ROUGHCONDUCTOR_H

#include "bsdfs/conductor.h"
#include "bsdfs/microfacet_distribution.h"
#include "shared/parameters.h"

#define OPAL_BSDF_roughconductor(PARAMETER) OPAL_METAL(PARAMETER) OPAL_FACETS(PARAMETER)

#endif
