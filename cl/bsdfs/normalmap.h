// The parameters of BSDF normalmap: a BSDF about normals of a texture (bsdfs/normalmap.cl).
#ifndef OPAL_BSDF_NORMALMAP_H
#define OPAL_BSDF_NORMALMAP_H

#include "bsdfs/perturb.h"
#include "shared/parameters.h"

#define OPAL_BSDF_normalmap(PARAMETER) \
    PARAMETER(COLOR, normal, "normalmap", 0.5, ANY, \
              "(n + 1) / 2 of the shading normal n along dp/du, across it and along the surface's own; 0.5: its own") \
    OPAL_PERTURBING(PARAMETER)

#endif
