#include "flatten/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace opal {

void fill_thinlens(const Camera &camera, double scale, ThinLensCamera &own) {
    constexpr double largest = std::numeric_limits<float>::max(); // which a radius of 0 may meet
    const double tangent = std::tan(camera.thinlens.fov * (std::numbers::pi / 360));
    own.tan_half_x = float(tangent);
    own.tan_half_y = float(tangent * camera.height / camera.width);
    own.aperture_radius = float(camera.thinlens.aperture_radius * scale);
    own.inverse_focus = float(std::min(1 / (camera.thinlens.focus_distance * scale), largest));
}

} // namespace opal
