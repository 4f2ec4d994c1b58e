// The parameters of every BSDF whose surface is made of facets (bsdfs/microfacet_distribution.cl).
#ifndef OPAL_MICROFACET_DISTRIBUTION_H
#define OPAL_MICROFACET_DISTRIBUTION_H

#include "shared/parameters.h"

#define OPAL_FACETS(PARAMETER) \
    PARAMETER(NUMBER, alpha_u, "alpha_u", 0.1, BETWEEN(0, 1), "roughness along u; `alpha`: of both") \
    PARAMETER(NUMBER, alpha_v, "alpha_v", 0.1, BETWEEN(0, 1), "roughness along v") \
    OPAL_FACET_CHOICES(PARAMETER)

// Which facets there are, and which are drawn.
#define OPAL_FACET_CHOICES(PARAMETER) \
    PARAMETER(FLAG, ggx, "ggx", false, ANY, "the distribution of the facets is GGX, else Beckmann's") \
    PARAMETER(FLAG, sample_visible, "sample_visible", true, ANY, \
              "directions are drawn by the visible facets, else by all")

// The least roughness that is not 0: smaller ones count as this.
#define LEAST_ALPHA 1e-6f

#endif
