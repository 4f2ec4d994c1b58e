// checkerboard: squares of two colours, two by two in the unit square of texture coordinates.
//   <texture name="reflectance" type="checkerboard"> <rgb name="color0" value="0.4"/> <rgb name="color1" value="0.2"/>
//   </texture>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rows.cl"
#include "scene.cl"
#include "textures/interface.cl"
#include "textures/list.h"

// Is the coordinate in the first half of its period? The end of that half is.
static mask in_first_half(real x) { return x - floor(x) <= R(0.5); }

static v3 texture_checkerboard_color(const Scene *scene, uints at, TexturePoint point, mask active) {
    global const texture_checkerboard_record *record = (global const texture_checkerboard_record *)scene->textures;
    v2 uv = texture_uv(v3_at(record->to_uv[0], at), v3_at(record->to_uv[1], at), point.uv);
    mask first = in_first_half(uv.x) == in_first_half(uv.y);
    return v3_pick(first, v3_at(record->color0, at), v3_at(record->color1, at));
}
