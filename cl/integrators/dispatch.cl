// dispatch: one step of the chosen integrator (integrators/NAME.cl for each row of list.h).
//   mask NAME_step(scene, path, hit, active)   adds what the path finds at `hit` to its radiance and sets its next ray;
//                                              returns the lanes whose path goes on
#include "core/lanes.cl"
#include "integrators/*.cl"
#include "scene.cl"
#include "shared/strategy.h"

static mask integrator_step(const Scene *scene, Path *path, Hit hit, mask active) {
#define STEP(axis, name, help) if (CHOSEN(scene, integrator, name)) return name##_step(scene, path, hit, active);
    OPAL_CHOICES_integrator(STEP)
    return NO_LANES;
}

// The lanes whose path ends where its ray hits, and asks there for nothing but the light that it meets.
static mask on_last_ray(const Scene *scene, const Path *path) {
    if (!OPAL_HAS_last_rays) return NO_LANES;
    if (CHOSEN(scene, integrator, direct_lighting)) return to_mask(path->depth > 1u);
    return to_mask(path->depth >= scene->settings->max_depth);
}
