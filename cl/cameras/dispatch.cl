// dispatch: rays of the scene's camera, picked by kind.
#include "cameras/*.cl"
#include "cameras/interface.cl"
#include "cameras/list.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"

// The ray of a sample at `offset` in pixel (x, y): unit direction, clipped by the planar near and far distances. lens:
// lens_numbers of the sample.
static Ray camera_ray(const Scene *scene, uints x, uints y, v2 offset, v2 lens) {
    global const CameraRecord *camera = scene->cameras;
    v2 film = v2_of((to_real(x) + offset.x) / (real1)scene->settings->width,
                    (to_real(y) + offset.y) / (real1)scene->settings->height);
#define RAY(name, record, traits) \
    if (OPAL_HAS_camera_##name && (CAMERA_KINDS == 1 || camera->kind == CAMERA_##name)) \
        return name##_ray(camera, film, lens);
    OPAL_CAMERAS(RAY)
    Ray none = {v3_all((real)(0)), v3_all((real)(0)), (real)(0), (real)(-1)};
    return none;
}
