// camera: rays through the film.
//
// The film position (sx, sy) in [0, 1]^2 has its origin at the top left. Camera space looks along +z, with +x to the
// left in the image.
#include "core/lanes.cl"
#include "core/rng.cl"
#include "scene.cl"
#include "shared/types.h"

// Position of a sample within its pixel, in [0, 1)^2.
static v2 film_offset(const Scene *scene, Sampler s) { return draw(scene, s, (uints)(DIM_FILM)); }

// The ray of a sample at `offset` in pixel (x, y): unit direction, clipped by the planar near and far distances.
static Ray camera_ray(const Scene *scene, uints x, uints y, v2 offset) {
    global const Settings *settings = scene->settings;
    real sx = (to_real(x) + offset.x) / (real1)settings->width;
    real sy = (to_real(y) + offset.y) / (real1)settings->height;
    v3 d = v3_mad(v3_from(settings->camera_left), (1 - 2 * sx) * settings->tan_half_x,
                  v3_mad(v3_from(settings->camera_up), (1 - 2 * sy) * settings->tan_half_y,
                         v3_from(settings->camera_forward)));
    real length = sqrt(v3_dot(d, d)); // the planar distance z is z * length along the unit direction
    Ray ray = {v3_from(settings->camera_origin), v3_scale(d, 1 / length), settings->near_clip * length,
               settings->far_clip * length};
    return ray;
}
