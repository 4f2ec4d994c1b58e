// sphere: a sphere that emits.
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "surface.cl"

static LightSample emitter_sphere_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u, u2 bits) {
    return no_light_sample();
}

static v3 emitter_sphere_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return v3_all((real)(0));
}

static real emitter_sphere_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    return (real)(0);
}
