// normals: shading normals as colours: |n|, or n/2 + 1/2 where `signed` is true.
#include "core/lanes.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "surface.cl"

static mask normals_step(const Scene *scene, Path *path, Hit hit, mask active) {
    active = active & is_hit(hit);
    if (!ANY(active)) return active;
    v3 n = surface_at(scene, path->ray, hit, active).frame.n;
    v3 color = scene->settings->normals_signed ? v3_mad(n, (real)(R(0.5)), v3_all((real)(R(0.5)))) : v3_abs(n);
    path->radiance = v3_pick(active, color, path->radiance);
    return NO_LANES;
}
