// parallelogram: an area light o + x u + y v that emits on the side of u x v, or on both, sampled uniformly over its
// area.
//   <mesh type="parallelogram"> ... <emitter type="area"> <color name="radiance" value="40 40 40"/> </emitter> </mesh>
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/area_light.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "surface.cl"
#include "textures/interface.cl"

static LightSample emitter_parallelogram_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u,
                                                u2 bits) {
    v3 corner = GATHER_V3(scene->emitters, id, .u.of_parallelogram.origin);
    v3 e1 = GATHER_V3(scene->emitters, id, .u.of_parallelogram.u);
    v3 e2 = GATHER_V3(scene->emitters, id, .u.of_parallelogram.v);
    v3 normal = GATHER_V3(scene->emitters, id, .u.of_parallelogram.normal);
    if (OPAL_HAS_light_textures && OPAL_HAS_uv) {
        mask exchanged = to_mask(GATHER(uints, scene->emitters, id, .u.of_parallelogram.uv_exchanged) != 0);
        TexturePoint point = texture_point_at(v2_of(exchanged ? u.y : u.x, exchanged ? u.x : u.y));
        color = textured_light(scene, id, EMITTER_parallelogram, color, point);
    }
    real offset = ray_offset_of(corner, v3_add(corner, v3_add(e1, e2)), v3_add(corner, e1));
    return sample_of_point(from, v3_mad(e1, u.x, v3_mad(e2, u.y, corner)), normal, normal,
                           emits_on_both_sides(scene, id),
                           GATHER(real, scene->emitters, id, .u.of_parallelogram.area), offset, color);
}

static v3 emitter_parallelogram_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return color;
}

static real emitter_parallelogram_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    return pdf_of_hit(GATHER(real, scene->emitters, id, .u.of_parallelogram.area), d, s);
}
