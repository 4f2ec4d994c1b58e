// parallelogram: an area light o + x u + y v that emits on the side of u x v, sampled uniformly over its area.
//   <mesh type="parallelogram"> ... <emitter type="area"> <color name="radiance" value="40 40 40"/> </emitter> </mesh>
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "surface.cl"

static EmitterSample emitter_parallelogram_sample(const Scene *scene, uints id, v2 point, u2 triangle) {
    v3 o = GATHER_V3(scene->emitters, id, .origin);
    v3 u = GATHER_V3(scene->emitters, id, .u), v = GATHER_V3(scene->emitters, id, .v);
    EmitterSample s;
    s.p = v3_mad(u, point.x, v3_mad(v, point.y, o));
    s.normal = s.shading_normal = GATHER_V3(scene->emitters, id, .normal);
    s.inverse_pdf = GATHER(real, scene->emitters, id, .area);
    s.ray_offset = ray_offset_of(o, v3_add(o, v3_add(u, v)), v3_add(o, u));
    s.discrete = NO_LANES;
    return s;
}
