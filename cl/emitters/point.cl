// point: a point light of the same intensity in all directions; only light sampling finds it.
//   <emitter type="point"> <point name="position" value="0 1 0"/> <color name="power" value="10 10 10"/> </emitter>
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/interface.cl"
#include "scene.cl"

static EmitterSample emitter_point_sample(const Scene *scene, uints id, v2 point, u2 triangle) {
    EmitterSample s;
    s.p = GATHER_V3(scene->emitters, id, .origin);
    s.normal = s.shading_normal = v3_all((real)(0));
    s.inverse_pdf = 1;
    s.ray_offset = 0;
    s.discrete = ALL_LANES;
    return s;
}
