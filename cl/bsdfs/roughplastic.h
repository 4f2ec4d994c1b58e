// The parameters of BSDF roughplastic: a transparent coat of rough facets over a diffuse base (bsdfs/roughplastic.cl).
#ifndef OPAL_BSDF_ROUGHPLASTIC_H
#define OPAL_BSDF_ROUGHPLASTIC_H

#include "bsdfs/microfacet_distribution.h"
#include "bsdfs/plastic.h"
#include "shared/parameters.h"

#define OPAL_BSDF_roughplastic(PARAMETER) \
    OPAL_BSDF_plastic(PARAMETER) \
    PARAMETER(NUMBER, alpha, "alpha", 0.1, BETWEEN(0, 1), "roughness") \
    OPAL_FACET_CHOICES(PARAMETER)

#endif
