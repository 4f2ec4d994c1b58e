// sphere: spheres, exact.
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shapes/interface.cl"
#include "shapes/list.h"
#include "shared/types.h"
#include "surface.cl"

static BlockTest intersect_sphere(global const SphereBlock *block, uint place, const LaneRay *ray) {
    BlockTest none = {0, 0, 0, 0, 0};
    return none;
}

static Surface surface_of_sphere(const Scene *scene, Ray ray, Hit hit, mask active) { return no_surface(); }
