// The boundary between the coat of a plastic and what is outside, seen by diffuse light of the base below.
#pragma once

#include "bsdfs/list.h"

#include <vector>

namespace opal {

// The part of diffuse light in a medium that its smooth boundary reflects back. eta: index of refraction outside over
// that of the medium, above 0. As Mitsuba has it, a fit: below 1 that of Egan and Hilgeman (1973), else that
// of d'Eon and Irving (2011, "A Quantized-Diffusion Model for Rendering Translucent Materials"). Right to 0.1 % from
// 0.5 on; below 0.26 it is above 1.
double diffuse_reflectance_fit(double eta);

// The same, exact: the integral of Fresnel's reflectance times 2 cos over the cosine.
double diffuse_reflectance(double eta);

// The numbers of CURVE `boundary` (cl/bsdfs/plastic.h): of a smooth plastic PLASTIC_INSIDE alone, the fit; of facets
// all. Those are what facets reflect and transmit of light that meets them once, in Smith's model, by the quadrature
// that Mitsuba has, with its points: 32 x 32 towards the denser side and 128 x 128 towards the other one, for each of
// 64 cosines. The inside is the mean over these cosines, the ends counted whole, which is up to 1 % off. They take
// about 0.04 s.
std::vector<float> plastic_boundary(const bsdf_plastic_record &plastic);
std::vector<float> plastic_boundary(const bsdf_roughplastic_record &plastic);

} // namespace opal
