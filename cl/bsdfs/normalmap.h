// The parameters of BSDF normalmap: a BSDF about normals of a texture (bsdfs/normalmap.cl).
#ifndef OPAL_BSDF_NORMALMAP_H
#define OPAL_BSDF_NORMALMAP_H

#include "shared/parameters.h"

#define OPAL_BSDF_normalmap(PARAMETER) \
    PARAMETER(COLOR, normal, "normalmap", 0.5, ANY, \
              "(n + 1) / 2 of the shading normal n along dp/du, across it and along the surface's own; 0.5: its own") \
    PARAMETER(FLAG, flip_invalid_normals, "flip_invalid_normals", true, ANY, \
              "turn normals that face away from the viewer about the surface's own") \
    PARAMETER(FLAG, use_shadowing_function, "use_shadowing_function", true, ANY, \
              "darken light at grazing angles to the surface's own normal") \
    PARAMETER(BSDF, base, "", 0, ANY, "the BSDF about these normals")

#endif
