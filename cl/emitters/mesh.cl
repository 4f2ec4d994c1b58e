// mesh: a triangle mesh that emits on the side of its shading normals. A triangle is chosen by area or uniformly
// (--triangle-choice), then a point on it uniformly; the density is that of both choices.
//   <mesh type="obj"> ... <emitter type="area"> <color name="radiance" value="40 40 40"/> </emitter> </mesh>
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/alias_table.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "shapes/triangle.cl"
#include "surface.cl"

static EmitterSample emitter_mesh_sample(const Scene *scene, uints id, v2 point, u2 triangle) {
    uints first = GATHER(uints, scene->emitters, id, .first), count = GATHER(uints, scene->emitters, id, .count), row;
    ALIAS_ENTRY(scene, light_triangles, first, count, triangle, row)
    uints slot = GATHER(uints, scene->light_triangles, row, .slot);

    // Uniform on the triangle: the square folded along its diagonal keeps the strata of `point`.
    mask folded = point.x + point.y > 1;
    real u = folded ? 1 - point.x : point.x, v = folded ? 1 - point.y : point.y;
    v3 p0 = triangle_vertex(scene, slot, 0), p1 = triangle_vertex(scene, slot, 1), p2 = triangle_vertex(scene, slot, 2);
    v3 e1 = v3_sub(p1, p0), e2 = v3_sub(p2, p0);
    v3 n = v3_cross(e1, e2);

    EmitterSample s;
    s.p = v3_mad(e1, u, v3_mad(e2, v, p0));
    s.normal = v3_normalize(n);
    s.shading_normal = shading_normal(scene, corner_normals(scene, triangle_id(scene, slot)), u, v, s.normal);
    s.inverse_pdf = GATHER(real, scene->light_triangles, row, .inverse_pdf);
    s.ray_offset = ray_offset_of(p0, p1, p2);
    s.discrete = NO_LANES;
    return s;
}
