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

// The textures' own coordinates, by the rows of to_uv.
static v2 texture_uv(v3 to_u, v3 to_v, v2 uv) {
    return v2_of(to_u.x * uv.x + to_u.y * uv.y + to_u.z, to_v.x * uv.x + to_v.y * uv.y + to_v.z);
}
