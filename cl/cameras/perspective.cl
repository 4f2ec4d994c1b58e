// perspective: a pinhole.
//   fov   full horizontal angle, degrees
#include "cameras/interface.cl"
#include "cameras/list.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"

static Ray perspective_ray(global const CameraRecord *camera, v2 film, v2 lens) {
    global const PerspectiveCamera *own = &camera->own.perspective;
    return camera_ray_along(camera, v3_from(camera->origin), (1 - 2 * film.x) * own->tan_half_x + own->shift_x,
                            (1 - 2 * film.y) * own->tan_half_y + own->shift_y);
}
