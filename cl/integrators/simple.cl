// simple: one point light and no materials: energy / (4 pi^2) max(0, cos) / distance^2 where the light is seen.
//   position   of the light
//   energy     W, linear RGB
#include "core/lanes.cl"
#include "core/math.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "surface.cl"
#include "trace/trace.cl"

static mask simple_step(const Scene *scene, Path *path, Hit hit, mask active) {
    active = active & is_hit(hit);
    if (!ANY(active)) return active;
    Surface s = surface_at(scene, path->ray, hit, active);
    v3 light = v3_from(scene->settings->light_position);
    v3 to_light = v3_sub(light, s.p);
    real distance2 = v3_dot(to_light, to_light);
    real cosine = v3_dot(s.frame.n, to_light) * rsqrt(distance2);
    active = active & (cosine > 0) & (distance2 > 0);
    v3 start = leave_surface(&s, to_light);
    Ray ray = {start, v3_sub(light, start), (real)(0), (real)(1)};
    active = active & !any_hit(scene, ray, active);
    v3 energy = v3_from(scene->settings->light_energy);
    v3 radiance = v3_scale(energy, cosine / distance2 * INV_PI * INV_FOUR_PI);
    path->radiance = v3_pick(active, radiance, path->radiance);
    return NO_LANES;
}
