// point: a point light of the same intensity in all directions; only light sampling finds it.
//   <emitter type="point"> <point name="position" value="0 1 0"/> <color name="power" value="10 10 10"/> </emitter>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "surface.cl"

static LightSample emitter_point_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u, u2 bits) {
    v3 p = GATHER_V3(scene->emitters, id, .u.of_point.position), to_light = v3_sub(p, from.p);
    real distance2 = v3_dot(to_light, to_light), inverse_distance = rsqrt(distance2);
    return light_sample_of(v3_scale(to_light, inverse_distance), distance2 * inverse_distance,
                           v3_scale(color, square(inverse_distance)), (real)(1), p, inverse_distance < FAR);
}

static v3 emitter_point_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return v3_all((real)(0));
}

static real emitter_point_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    return (real)(0);
}
