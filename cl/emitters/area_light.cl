// area_light: what emitters on surfaces share. A point is drawn on the surface; its density over the area becomes that
// of its direction over the solid angle.
#include "core/lanes.cl"
#include "core/math.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "surface.cl"

// 1 / pdf, solid angle measure, of a direction d that meets a surface of that normal, given 1 / pdf, area measure, of
// the point: times cosine / distance^2.
static real area_to_solid_angle(real inverse_pdf, v3 normal, v3 d, real inverse_distance) {
    return inverse_pdf * fabs(v3_dot(normal, d)) * square(inverse_distance);
}

// The lanes whose emitter `id`, of a mesh, emits on both sides.
static mask emits_on_both_sides(const Scene *scene, uints id) {
    if (!OPAL_HAS_two_sided_lights) return NO_LANES;
    return to_mask(GATHER(uints, scene->emitters, id, .two_sided) != 0);
}

// The direction to the point p of an emitting surface. normal: geometric; light leaves on the shading normal's side, or
// on both.
// inverse_pdf: 1 / pdf of p, area measure; offset: how far above the surface shadow rays end (ray_offset_of)
static LightSample sample_of_point(ReferencePoint from, v3 p, v3 normal, v3 shading_normal, mask both_sides,
                                   real inverse_pdf, real offset, v3 radiance) {
    v3 to_light = v3_sub(p, from.p);
    real distance2 = v3_dot(to_light, to_light), inverse_distance = rsqrt(distance2);
    v3 d = v3_scale(to_light, inverse_distance);
    mask active = ((v3_dot(shading_normal, to_light) < 0) | both_sides) & (inverse_distance < FAR);
    // The shadow ray ends above the surface, on the side that it comes from.
    v3 end = v3_mad(normal, copysign(offset, -v3_dot(normal, to_light)), p);
    return light_sample_of(d, distance2 * inverse_distance, radiance,
                           area_to_solid_angle(inverse_pdf, normal, d, inverse_distance), end, active);
}

// The density with which sample_of_point finds the direction d of a ray that met the surface s:
// 1 / area_to_solid_angle(), by one division.
static real pdf_of_hit(real inverse_pdf, v3 d, const Surface *s) {
    return square(s->t) / (inverse_pdf * fabs(v3_dot(s->normal, d)));
}
