// ao: ambient occlusion: the cosine-weighted share of the unbounded hemisphere that nothing blocks.
//   cosine_sampling   draw directions in proportion to their cosine (--hemisphere cosine), else uniformly
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "surface.cl"
#include "trace/trace.cl"

static mask ao_step(const Scene *scene, Path *path, Hit hit, mask active) {
    active = active & is_hit(hit);
    if (!ANY(active)) return active;
    Surface s = surface_at(scene, path->ray, hit, active);
    v2 u = path_draw(scene, path, DIM_BSDF);
    int cosine = CHOSEN(scene, hemisphere, cosine);
    v3 wo = cosine ? square_to_cosine_hemisphere(u) : square_to_uniform_hemisphere(u);
    real weight = cosine ? (real)(1) : 2 * wo.z; // cos / pi over the density
    v3 d = to_world(s.frame, wo);
    Ray ray = {leave_surface(&s, d), d, (real)(0), (real)(FAR)};
    mask open = active & !any_hit(scene, ray, active);
    path->radiance = v3_pick(open, v3_all(weight), path->radiance);
    return NO_LANES;
}
