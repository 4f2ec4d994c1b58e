// The parameters of BSDF principled: Disney's material (bsdfs/principled.cl).
#ifndef OPAL_BSDF_PRINCIPLED_H
#define OPAL_BSDF_PRINCIPLED_H

#include "shared/parameters.h"

#define OPAL_BSDF_principled(PARAMETER) \
    PARAMETER(COLOR, base_color, "baseColor", 0.5, BETWEEN(0, 1), \
              "colour of the base, of metal, and squared of transmitted light") \
    PARAMETER(NUMBER, roughness, "roughness", 0.5, BETWEEN(0, 1), "square root of the facets' alpha (GGX)") \
    PARAMETER(NUMBER, anisotropic, "anisotropic", 0, BETWEEN(0, 1), "how far highlights are stretched along dp/du") \
    PARAMETER(NUMBER, metallic, "metallic", 0, BETWEEN(0, 1), "1: metal, 0: a dielectric") \
    PARAMETER(NUMBER, spec_trans, "specTrans", 0, BETWEEN(0, 1), "share of rough glass in what is no metal") \
    PARAMETER(NUMBER, eta, "eta", 1.5, ABOVE(0), \
              "index of refraction inside over outside; in its place specular, 0 to 1 (0.5 is 1.5)") \
    PARAMETER(NUMBER, spec_tint, "specularTint", 0, BETWEEN(0, 1), "how far the base tints the reflection") \
    PARAMETER(NUMBER, sheen, "sheen", 0, BETWEEN(0, 1), "strength of the sheen at grazing angles, as of cloth") \
    PARAMETER(NUMBER, sheen_tint, "sheenTint", 0, BETWEEN(0, 1), "how far the base tints the sheen") \
    PARAMETER(NUMBER, flatness, "flatness", 0, BETWEEN(0, 1), \
              "share of approximated subsurface scattering in the diffuse part") \
    PARAMETER(NUMBER, clearcoat, "clearcoat", 0, BETWEEN(0, 1), "strength of the clear coat") \
    PARAMETER(NUMBER, clearcoat_gloss, "clearcoatGloss", 0, BETWEEN(0, 1), \
              "its gloss: alpha is 0.1 at 0 and 0.001 at 1")

#endif
