// interface: what every texture offers (textures/NAME.cl for each row of textures/list.h).
//   v3 texture_NAME_color(scene, at, point, active)   linear RGB at `point` of the textures whose records begin at word
//                                                     `at`
// Functions compute all lanes; their callers pick the active ones. The record of another lane may be of another kind:
// an index that comes from it must not be followed.
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shared/types.h"
#include "surface.cl"

// Where textures are looked up.
typedef struct {
    v2 uv;           // texture coordinates
    real b1, b2;     // on triangles, barycentric weights of corners 1 and 2, in the order that the device has them
    uints primitive; // as in Surface; OPAL_NONE where a light is no triangle
} TexturePoint;

static TexturePoint texture_point(v2 uv, real b1, real b2, uints primitive) {
    TexturePoint point = {uv, b1, b2, primitive};
    return point;
}
static TexturePoint texture_point_of(const Surface *s) { return texture_point(s->uv, s->u, s->v, s->primitive); }
static TexturePoint texture_point_at(v2 uv) { return texture_point(uv, (real)(0), (real)(0), (uints)(OPAL_NONE)); }

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
