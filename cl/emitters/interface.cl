// interface: what every emitter offers (emitters/NAME.cl for each row of emitters/list.h).
//   EmitterSample emitter_NAME_sample(scene, id, point, triangle)   a point on the emitters `id`, one a lane
// point: a pair of random numbers in [0, 1); triangle: a pair of random words, by which a mesh chooses a triangle.
// Functions compute all lanes; their callers pick those that are meant.
#include "core/lanes.cl"

// A point on an emitter. Lengths are those of the flattened scene.
typedef struct {
    v3 p;              // the point
    v3 normal;         // geometric normal there, unit; 0 for a point light
    v3 shading_normal; // unit; light leaves on its side. 0 for a point light
    real inverse_pdf;  // 1 / pdf of p, area measure, given the emitter; 1 for a point light
    real ray_offset;   // how far above the surface shadow rays end (ray_offset_of); 0 for a point light
    mask discrete;     // a point light: no direction hits it by chance
} EmitterSample;

static EmitterSample emitter_sample_pick(mask m, EmitterSample yes, EmitterSample no) {
    EmitterSample s = {v3_pick(m, yes.p, no.p), v3_pick(m, yes.normal, no.normal),
                       v3_pick(m, yes.shading_normal, no.shading_normal), m ? yes.inverse_pdf : no.inverse_pdf,
                       m ? yes.ray_offset : no.ray_offset, m ? yes.discrete : no.discrete};
    return s;
}

// Where a shadow ray towards the light ends: above its surface, on the side that to_light comes from.
static v3 shadow_ray_end(EmitterSample light, v3 to_light) {
    return v3_mad(light.normal, copysign(light.ray_offset, -v3_dot(light.normal, to_light)), light.p);
}
