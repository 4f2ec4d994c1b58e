// thinlens: a thin lens.
#include "cameras/interface.cl"
#include "cameras/list.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"

static Ray thinlens_ray(global const CameraRecord *camera, v2 film, v2 lens) {
    global const ThinLensCamera *own = &camera->own.thinlens;
    return camera_ray_along(camera, v3_from(camera->origin), (1 - 2 * film.x) * own->tan_half_x,
                            (1 - 2 * film.y) * own->tan_half_y);
}
