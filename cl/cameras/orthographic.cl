// orthographic: parallel rays.
#include "cameras/interface.cl"
#include "cameras/list.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"

static Ray orthographic_ray(global const CameraRecord *camera, v2 film, v2 lens) {
    return camera_ray_along(camera, v3_from(camera->origin), (real)(0), (real)(0));
}
