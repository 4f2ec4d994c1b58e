// interface: what every texture offers (textures/NAME.cl for each row of textures/list.h).
//   v3 texture_NAME_color(scene, at, uv, active)   linear RGB at the surface's coordinates `uv` of the textures whose
//                                                  records begin at word `at`
// Functions compute all lanes; their callers pick the active ones. The record of another lane may be of another kind:
// an index that comes from it must not be followed.
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"

// Three words of the records that begin at word `at`; `member` is that of the table's first record.
static v3 texture_words(global const float *member, uints at) {
    return v3_of(GATHER_WORD(real, member, at), GATHER_WORD(real, (member + 1), at),
                 GATHER_WORD(real, (member + 2), at));
}

// The textures' own coordinates. to_uv: the member of the table's first record
static v2 texture_uv(global const float (*to_uv)[3], uints at, v2 uv) {
    v3 x = texture_words(to_uv[0], at), y = texture_words(to_uv[1], at);
    return v2_of(x.x * uv.x + x.y * uv.y + x.z, y.x * uv.x + y.y * uv.y + y.z);
}
