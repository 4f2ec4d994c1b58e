// interface: what a camera offers, and what the camera of this kernel needs.
//   Ray NAME_ray(camera, film, lens)   the ray through a point of the film, made by camera_ray_along; lens: a pair of
//                                      random numbers, for cameras with the trait OPAL_DRAWS_LENS
// The film is [0, 1]^2 with its origin at the top left. Camera space looks along +z, with +x to the left in the image.
#include "cameras/list.h"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "scene.cl"

#define COUNT_CAMERA(name, record, traits) +OPAL_HAS_camera_##name
#define COUNT_LENS(name, record, traits) +(OPAL_HAS_camera_##name && ((traits) & OPAL_DRAWS_LENS))
#define COUNT_ORIGINS(name, record, traits) +(OPAL_HAS_camera_##name && !((traits) & OPAL_ONE_ORIGIN))
enum {
    CAMERA_KINDS = 0 OPAL_CAMERAS(COUNT_CAMERA),        // of this kernel
    CAMERAS_WITH_LENS = 0 OPAL_CAMERAS(COUNT_LENS),
    CAMERAS_OF_MANY_ORIGINS = 0 OPAL_CAMERAS(COUNT_ORIGINS)
};

// Position of a sample within its pixel, in [0, 1)^2.
static v2 film_offset(const Scene *scene, Sampler s) { return draw(scene, s, (uints)(DIM_FILM)); }

// The sample's pair of numbers for the lens; 0 where no camera of the kernel has one.
static v2 lens_numbers(const Scene *scene, Sampler s) {
    if (CAMERAS_WITH_LENS == 0) return v2_of((real)(0), (real)(0));
    return draw(scene, s, segment_dimension((uints)(0), DIM_LENS));
}

// The ray from `origin` along x left + y up + forward: unit direction, clipped by the planar near and far distances.
static Ray camera_ray_along(global const CameraRecord *camera, v3 origin, real x, real y) {
    v3 d = v3_mad(v3_from(camera->left), x, v3_mad(v3_from(camera->up), y, v3_from(camera->forward)));
    real length = sqrt(v3_dot(d, d)); // the planar distance z is z * length along the unit direction
    Ray ray = {origin, v3_scale(d, 1 / length), camera->near_clip * length, camera->far_clip * length};
    return ray;
}
