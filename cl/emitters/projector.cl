// projector: a point light that throws an image onto what is before it; only light sampling finds it. On any plane
// across its axis the irradiance is that of the image: the intensity grows with the third power of 1 / cosine of the
// angle to the axis (Mitsuba). A texture multiplies it: its unit square is the image.
//   <emitter type="projector"> <point name="position" value="0 3 0"/> <vector name="direction" value="0 -1 0"/>
//     <color name="irradiance" value="10 10 10"/> <float name="fov" value="40"/> </emitter>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "emitters/interface.cl"
#include "emitters/list.h"
#include "scene.cl"
#include "surface.cl"
#include "textures/interface.cl"

static LightSample emitter_projector_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u,
                                            u2 bits) {
    v3 p = GATHER_V3(scene->emitters, id, .u.of_projector.position), to_light = v3_sub(p, from.p);
    real distance2 = v3_dot(to_light, to_light), inverse_distance = rsqrt(distance2);
    v3 d = v3_scale(to_light, inverse_distance);
    v3 axis = GATHER_V3(scene->emitters, id, .u.of_projector.direction);
    real cosine = -v3_dot(d, axis);
    v2 uv = plane_uv(v3_neg(d), axis, GATHER_V3(scene->emitters, id, .u.of_projector.across[0]),
                     GATHER_V3(scene->emitters, id, .u.of_projector.across[1]));
    mask lit = (cosine > 0) & (uv.x >= 0) & (uv.x <= 1) & (uv.y >= 0) & (uv.y <= 1);
    color = textured_light(scene, id, EMITTER_projector, color, texture_point_at(uv));
    real falloff = lit ? 1 / (cosine * cosine * cosine) : (real)(0);
    return light_sample_of(d, distance2 * inverse_distance, v3_scale(color, falloff * square(inverse_distance)),
                           (real)(1), p, (inverse_distance < FAR) & lit);
}

static v3 emitter_projector_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return v3_all((real)(0));
}

static real emitter_projector_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    return (real)(0);
}
