#include "flatten/camera.h"

namespace opal {

void fill_orthographic(const Camera &camera, double scale, OrthographicCamera &own) {
    own.half_x = float(scale);
    own.half_y = float(scale * camera.height / camera.width);
}

} // namespace opal
