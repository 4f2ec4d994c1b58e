// constant: an environment that sends the same radiance from all directions, sampled uniformly over the sphere.
//   <emitter type="constant"> <color name="radiance" value="1 1 1"/> </emitter>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "surface.cl"

static LightSample emitter_constant_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u, u2 bits) {
    v3 d = square_to_uniform_sphere(u);
    return light_sample_of(d, (real)(FAR), color, 1 / square_to_uniform_sphere_pdf(d), from.p, ALL_LANES);
}

static v3 emitter_constant_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return color;
}

static real emitter_constant_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    return square_to_uniform_sphere_pdf(d);
}
