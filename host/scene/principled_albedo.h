// How much light leaves a principled BSDF, by quadrature in double: its lobes are added without regard to each other,
// so that it may be more than comes (scenes/README.md).
#pragma once

#include "base/color.h"
#include "base/math.h"
#include "bsdfs/list.h"

namespace opal {

// The directional albedo of the front from wi, a unit vector of the local frame with wi.z > 0: what is reflected and
// transmitted, as importance. To 1e-3 with 128 x 128 points for each lobe.
Color principled_albedo(const bsdf_principled_record &bsdf, Vec3 wi, int points = 128);

} // namespace opal
