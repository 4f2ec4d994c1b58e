#include "flatten/camera.h"

#include <cmath>
#include <numbers>

namespace opal {

void fill_perspective(const Camera &camera, double, PerspectiveCamera &own) {
    const double tangent = std::tan(camera.perspective.fov * (std::numbers::pi / 360));
    own.tan_half_x = float(tangent);
    own.tan_half_y = float(tangent * camera.height / camera.width);
    own.shift_x = float(2 * camera.perspective.principal_point_x * own.tan_half_x);
    own.shift_y = float(2 * camera.perspective.principal_point_y * own.tan_half_y);
}

} // namespace opal
