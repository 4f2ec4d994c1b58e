// bumpmap: a BSDF about the shading normals of a surface that a texture raises along its normal.
//   <bsdf type="bumpmap"> <texture type="bitmap"> <string name="filename" value="bricks.png"/>
//   <boolean name="raw" value="true"/> </texture> <float name="scale" value="0.05"/> <bsdf type="diffuse"/> </bsdf>
// The normal is that of the tangents dp/du + n dh/du and dp/dv + n dh/dv, on the geometric normal's side (Blinn 1978,
// "Simulation of Wrinkled Surfaces"). h's derivatives are those of the bilinear interpolation between texels. What
// keeps light right: bsdfs/perturb.cl.
#include "bsdfs/interface.cl"
#include "bsdfs/perturb.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "parameters.cl"
#include "scene.cl"
#include "surface.cl"
#include "textures/interface.cl"

// A vector over its largest coordinate, so that products of two neither overflow nor vanish.
static v3 scaled(v3 v) { return v3_scale(v, 1 / v3_largest(v3_abs(v))); }

static BsdfOpening bumpmap_open(const Scene *scene, const Surface *s, bumpmap_bsdf b, BsdfOpening o, mask m) {
    global const bsdf_bumpmap_record *record = (global const bsdf_bumpmap_record *)scene->bsdfs;
    v2 slope = number_gradient(scene, &record->height, b.at, texture_point_of(s), m);
    v3 u = seen_from(o, s->dpdu), v = seen_from(o, s->dpdv), side = seen_from(o, s->normal);
    u.z = slope.x * b.scale;
    v.z = slope.y * b.scale;
    v3 across = v3_cross(scaled(u), scaled(v));
    real length2 = v3_dot(across, across), sign = v3_dot(across, side) < 0 ? (real)(-1) : (real)(1);
    // Where the tangents span no plane, as at the poles of spheres, the surface keeps its own normal.
    v3 n = v3_pick(length2 > SHORTEST_NORMAL * SHORTEST_NORMAL, v3_scale(across, sign * rsqrt(length2)),
                   v3_of((real)(0), (real)(0), (real)(1)));
    o.at = b.base;
    return perturb(s, n, b.flip_invalid_normals, b.use_shadowing_function, o);
}
