// normalmap: a BSDF about shading normals that a texture gives, as (n + 1) / 2.
//   <bsdf type="normalmap"> <texture name="normalmap" type="bitmap"> <string name="filename" value="bricks.png"/>
//   <boolean name="raw" value="true"/> </texture> <bsdf type="diffuse"/> </bsdf>
// n has coordinates along dp/du made orthogonal to the surface's own normal, across it by the right hand, and along
// that normal. What keeps light right: bsdfs/perturb.cl.
#include "bsdfs/interface.cl"
#include "bsdfs/perturb.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "surface.cl"

static BsdfOpening normalmap_open(const Scene *scene, const Surface *s, normalmap_bsdf b, BsdfOpening o, mask m) {
    v3 z = v3_of((real)(0), (real)(0), (real)(1));
    v3 given = v3_sub(v3_scale(b.normal, (real)(2)), v3_all((real)(1)));
    real length2 = v3_dot(given, given);
    // A texel without a direction, as 0.5 0.5 0.5 is, leaves the surface its own.
    given = v3_pick(length2 > SHORTEST_NORMAL * SHORTEST_NORMAL, v3_scale(given, rsqrt(length2)), z);
    v3 n = to_world(tangent_frame(z, seen_from(o, s->dpdu)), given); // in o.frame
    o.at = b.base;
    return perturb(s, n, b.flip_invalid_normals, b.use_shadowing_function, o);
}
