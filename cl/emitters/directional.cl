// directional: parallel light from infinitely far, as that of the sun; only light sampling finds it.
//   <emitter type="directional"> <vector name="direction" value="1 -2 0"/> <color name="irradiance" value="3 3 2"/>
//   </emitter>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "surface.cl"

static LightSample emitter_directional_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u,
                                              u2 bits) {
    v3 d = v3_scale(GATHER_V3(scene->emitters, id, .u.of_directional.direction), (real)(-1));
    return light_sample_of(d, (real)(FAR), color, (real)(1), from.p, ALL_LANES);
}

static v3 emitter_directional_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return v3_all((real)(0));
}

static real emitter_directional_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    return (real)(0);
}
