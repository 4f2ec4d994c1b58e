// thinlens: a lens instead of the pinhole (Potmesil and Chakravarty 1982, "Synthetic Image Generation with a Lens and
// Aperture Camera Model"). All rays through a point of the film meet in a point of the plane at focalDistance.
//   <camera type="thinlens"> <float name="lensRadius" value="0.1"/> <float name="focalDistance" value="4"/> </camera>
#include "cameras/interface.cl"
#include "cameras/list.h"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/warp.cl"
#include "scene.cl"

static Ray thinlens_ray(global const CameraRecord *camera, v2 film, v2 lens) {
    global const ThinLensCamera *own = &camera->own.thinlens;
    v2 on_disk = square_to_concentric_disk(lens);
    real x = on_disk.x * own->aperture_radius, y = on_disk.y * own->aperture_radius;
    v3 start = v3_mad(v3_from(camera->left), x, v3_mad(v3_from(camera->up), y, v3_from(camera->origin)));
    return camera_ray_along(camera, start, (1 - 2 * film.x) * own->tan_half_x - x * own->inverse_focus,
                            (1 - 2 * film.y) * own->tan_half_y - y * own->inverse_focus);
}
