// av: average visibility (the first exercise of ETH's course): the share of the hemisphere around the shading normal,
// by solid angle, in which nothing is nearer than `length`. Where the camera sees nothing it is 1.
//   length   in the scene's units
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "surface.cl"
#include "trace/trace.cl"

static mask av_step(const Scene *scene, Path *path, Hit hit, mask active) {
    mask on_surface = active & is_hit(hit), open = active;
    if (ANY(on_surface)) {
        Surface s = surface_at(scene, path->ray, hit, on_surface);
        v3 d = to_world(s.frame, square_to_uniform_hemisphere(path_draw(scene, path, DIM_BSDF)));
        Ray ray = {leave_surface(&s, d), d, (real)(0), (real)(scene->settings->visibility_length)};
        open = active & !(on_surface & any_hit(scene, ray, on_surface));
    }
    path->radiance = v3_pick(open, v3_all((real)(1)), path->radiance);
    return NO_LANES;
}
