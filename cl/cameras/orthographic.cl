// orthographic: parallel rays along camera space's +z. The film's width spans [-1, 1] in camera space: a toWorld with a
// scale makes it larger.
#include "cameras/interface.cl"
#include "cameras/list.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"

static Ray orthographic_ray(global const CameraRecord *camera, v2 film, v2 lens) {
    global const OrthographicCamera *own = &camera->own.orthographic;
    v3 start = v3_mad(v3_from(camera->left), (1 - 2 * film.x) * own->half_x,
                      v3_mad(v3_from(camera->up), (1 - 2 * film.y) * own->half_y, v3_from(camera->origin)));
    return camera_ray_along(camera, start, (real)(0), (real)(0));
}
