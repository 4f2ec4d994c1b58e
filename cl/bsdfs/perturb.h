// The parameters of every BSDF that changes the shading normals of another one (bsdfs/perturb.cl).
#ifndef OPAL_PERTURB_H
#define OPAL_PERTURB_H

#include "shared/parameters.h"

#define OPAL_PERTURBING(PARAMETER) \
    PARAMETER(FLAG, flip_invalid_normals, "flip_invalid_normals", true, ANY, \
              "turn normals that face away from the viewer about the surface's own") \
    PARAMETER(FLAG, use_shadowing_function, "use_shadowing_function", true, ANY, \
              "darken light at grazing angles to the surface's own normal") \
    PARAMETER(BSDF, base, "", 0, ANY, "the BSDF about these normals")

#endif
