// The parameters of BSDF bumpmap: a BSDF about normals of a surface that a texture raises (bsdfs/bumpmap.cl).
#ifndef OPAL_BSDF_BUMPMAP_H
#define OPAL_BSDF_BUMPMAP_H

#include "bsdfs/perturb.h"
#include "shared/parameters.h"

#define OPAL_BSDF_bumpmap(PARAMETER) \
    PARAMETER(NUMBER, height, "height", 0, ANY, "how far the surface is raised along its normal") \
    PARAMETER(NUMBER, scale, "scale", 1, ANY, "factor of the height; height times scale is in the scene's units") \
    OPAL_PERTURBING(PARAMETER)

#endif
