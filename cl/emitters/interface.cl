// interface: what every emitter offers (emitters/NAME.cl for each row of emitters/list.h), and choosing by an alias
// table.
//   EmitterSample emitter_NAME_sample(scene, id, point, triangle)   a point on the emitters `id`, one a lane
// point: a pair of random numbers in [0, 1); triangle: a pair of random words, by which a mesh chooses a triangle.
// Functions compute all lanes; their callers pick those that are meant.
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/list.h"

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

// Row floor(k n 2^-24) of n rows, by the upper 24 bits k, which Sobol samples stratify. Tables of more than
// OPAL_ALIAS_ROWS rows would leave a row too few of these numbers and use all 32 bits.
static uints alias_row(uints bits, uints n) {
    uints used = uints_pick(to_mask(n > OPAL_ALIAS_ROWS), bits, bits & 0xffffff00u);
    return mul_hi(used, n);
}

// Sets `entry` to an entry of an alias table of n rows, given two random words; `first`: index of its first row in that
// table of records. Exactly the words that the host counted (flatten/distribution.cpp) lead to an entry, so that its
// probability in the records is exact.
#define ALIAS_ENTRY(scene, table, first, n, u, entry) { \
    uints row_ = alias_row((u).x, n); \
    mask kept_ = unit_real((u).y) < GATHER(real, (scene)->table, (first) + row_, .accept); \
    entry = (first) + uints_pick(kept_, row_, GATHER(uints, (scene)->table, (first) + row_, .other)); \
}
