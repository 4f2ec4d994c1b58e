#include "flatten/camera.h"

#include <cmath>
#include <numbers>

namespace opal {

void fill_thinlens(const Camera &camera, double scale, ThinLensCamera &own) {
    const double tangent = std::tan(camera.thinlens.fov * (std::numbers::pi / 360));
    own.tan_half_x = float(tangent);
    own.tan_half_y = float(tangent * camera.height / camera.width);
    own.aperture_radius = float(camera.thinlens.aperture_radius * scale);
    own.inverse_focus = float(1 / (camera.thinlens.focus_distance * scale));
}

} // namespace opal
