// The parameters of BSDF bumpmap: a BSDF about normals of a surface that a texture raises (bsdfs/bumpmap.cl).
#ifndef OPAL_BSDF_BUMPMAP_H
#define OPAL_BSDF_BUMPMAP_H

#include "shared/parameters.h"

#define OPAL_BSDF_bumpmap(PARAMETER) \
    PARAMETER(NUMBER, height, "height", 0, ANY, "how far the surface is raised along its normal") \
    PARAMETER(NUMBER, scale, "scale", 1, ANY, "factor of the height; height times scale is in the scene's units") \
    PARAMETER(FLAG, flip_invalid_normals, "flip_invalid_normals", true, ANY, \
              "turn normals that face away from the viewer about the surface's own") \
    PARAMETER(FLAG, use_shadowing_function, "use_shadowing_function", true, ANY, \
              "darken light at grazing angles to the surface's own normal") \
    PARAMETER(BSDF, base, "", 0, ANY, "the BSDF about these normals")

#endif
