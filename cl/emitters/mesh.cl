// mesh: a triangle mesh that emits on the side of its shading normals, or on both. A triangle is chosen by area or
// uniformly (--triangle-choice), then a point on it uniformly; the density is that of both choices.
//   <mesh type="obj"> ... <emitter type="area"> <color name="radiance" value="40 40 40"/> </emitter> </mesh>
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/alias_table.cl"
#include "emitters/area_light.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "shapes/triangle.cl"
#include "surface.cl"
#include "textures/interface.cl"

static LightSample emitter_mesh_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u, u2 bits) {
    uints first = GATHER(uints, scene->emitters, id, .first), count = GATHER(uints, scene->emitters, id, .count), row;
    ALIAS_ENTRY(scene, light_triangles, first, count, bits, row)
    uints slot = GATHER(uints, scene->light_triangles, row, .slot);

    // Uniform on the triangle: the square folded along its diagonal keeps the strata of u.
    mask folded = u.x + u.y > 1;
    real b1 = folded ? 1 - u.x : u.x, b2 = folded ? 1 - u.y : u.y;
    v3 p0 = triangle_vertex(scene, slot, 0), p1 = triangle_vertex(scene, slot, 1), p2 = triangle_vertex(scene, slot, 2);
    v3 e1 = v3_sub(p1, p0), e2 = v3_sub(p2, p0);
    v3 normal = v3_normalize(v3_cross(e1, e2));
    uints triangle = triangle_id(scene, slot);
    v3 shading = shading_normal(scene, corner_normals(scene, triangle), b1, b2, normal);
    if (OPAL_HAS_light_textures && OPAL_HAS_uv) {
        v2 uv = triangle_uv(corner_uvs(scene, triangle), b1, b2);
        color = textured_light(scene, id, EMITTER_mesh, color, texture_point(uv, b1, b2, triangle));
    }
    return sample_of_point(from, v3_mad(e1, b1, v3_mad(e2, b2, p0)), normal, shading, emits_on_both_sides(scene, id),
                           GATHER(real, scene->light_triangles, row, .inverse_pdf), ray_offset_of(p0, p1, p2), color);
}

static v3 emitter_mesh_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return color;
}

static real emitter_mesh_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    uints place = s->primitive - GATHER(uints, scene->emitters, id, .u.of_mesh.first_triangle);
    // In other lanes `place` may be anything.
    uints row = uints_pick(to_mask(place < GATHER(uints, scene->emitters, id, .count)),
                           GATHER(uints, scene->emitters, id, .first) + place, (uints)(0));
    return pdf_of_hit(GATHER(real, scene->light_triangles, row, .inverse_pdf), d, s);
}
