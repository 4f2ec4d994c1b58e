// The parameters of BSDF principledthin: Disney's material of a thin sheet (bsdfs/principledthin.cl).
#ifndef OPAL_BSDF_PRINCIPLEDTHIN_H
#define OPAL_BSDF_PRINCIPLEDTHIN_H

#include "shared/parameters.h"

#define OPAL_BSDF_principledthin(PARAMETER) \
    PARAMETER(COLOR, base_color, "baseColor", 0.5, BETWEEN(0, 1), "colour of the base and of transmitted light") \
    PARAMETER(NUMBER, roughness, "roughness", 0.5, BETWEEN(0, 1), "square root of the facets' alpha (GGX)") \
    PARAMETER(NUMBER, anisotropic, "anisotropic", 0, BETWEEN(0, 1), "how far highlights are stretched along dp/du") \
    PARAMETER(NUMBER, spec_trans, "specTrans", 0, BETWEEN(0, 1), "share of the specular part, else diffuse") \
    PARAMETER(NUMBER, eta, "eta", 1.5, ABOVE(0), "index of refraction inside over outside") \
    PARAMETER(NUMBER, spec_tint, "specularTint", 0, BETWEEN(0, 1), "how far the base tints the reflection") \
    PARAMETER(NUMBER, sheen, "sheen", 0, BETWEEN(0, 1), "strength of the sheen at grazing angles, as of cloth") \
    PARAMETER(NUMBER, sheen_tint, "sheenTint", 0, BETWEEN(0, 1), "how far the base tints the sheen") \
    PARAMETER(NUMBER, flatness, "flatness", 0, BETWEEN(0, 1), \
              "share of approximated subsurface scattering in the diffuse part") \
    PARAMETER(NUMBER, diff_trans, "diffTrans", 0, BETWEEN(0, 2), \
              "diffuse light: 0 is all reflected, 1 half and half, 2 all transmitted")

#endif
