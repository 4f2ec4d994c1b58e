// What readers of both formats do with the parameters of a BSDF.
#pragma once

#include "base/color.h"
#include "scene/scene.h"

#include <string>
#include <string_view>

namespace opal {

// Sets a COLOR of a BSDF, by its name.
void set_color(Bsdf &bsdf, std::string_view name, const Color &color);

// Whether the indices of refraction of a roughdielectric or roughplastic are one: then no facet refracts, and none can
// be told from the directions that it refracts; none reflects.
bool has_equal_indices(const Bsdf &bsdf);

// The smooth material that a rough one is whose roughness is 0: of a roughconductor the conductor, of a roughdielectric
// the dielectric, of a roughplastic the plastic, of others the same.
Bsdf without_facets(const Bsdf &bsdf);

// Whether the coat of a smooth plastic is so dense that no light of the base would leave it by Mitsuba's fit
// (flatten/plastic_boundary.h).
constexpr double densest_plastic = 3.8; // int_ior over ext_ior
bool is_too_dense(const Bsdf &bsdf);
std::string too_dense_text(const std::string &outside); // "must be at most 3.8 times extIOR"

} // namespace opal
