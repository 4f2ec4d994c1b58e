// The parameters of BSDF diffuse: one-sided Lambertian reflection (bsdfs/diffuse.cl).
#ifndef OPAL_BSDF_DIFFUSE_H
#define OPAL_BSDF_DIFFUSE_H

#include "shared/parameters.h"

#define OPAL_BSDF_diffuse(PARAMETER) \
    PARAMETER(COLOR, albedo, "albedo", 0.5, AT_LEAST(0), "reflectance") \
    PARAMETER(FLAG, use_cosine, "use_cosine", false, ANY, \
              "draw directions in proportion to their cosine, else uniformly")

#endif
