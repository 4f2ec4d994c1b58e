// sphere: a sphere that emits on the side of its normals, or on both. From outside it is sampled uniformly over the
// directions that it fills, a cone; from inside uniformly over all directions.
//   <mesh type="sphere"> ... <emitter type="area"> <color name="radiance" value="40 40 40"/> </emitter> </mesh>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "emitters/area_light.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "shapes/sphere.cl"
#include "surface.cl"
#include "textures/interface.cl"

// A sphere as a reference point sees it.
typedef struct {
    v3 center;
    real radius;
    v3 axis;       // to the centre, unit
    real distance; // of the centre
    real lowered;  // directions d are sampled with 1 - d.axis up to this
    mask inside;   // the point is inside
    mask lit;      // the sphere emits on that side
} SphereView;

static SphereView sphere_seen(const Scene *scene, uints id, ReferencePoint from) {
    SphereView view;
    view.center = GATHER_V3(scene->emitters, id, .u.of_sphere.center);
    view.radius = GATHER(real, scene->emitters, id, .u.of_sphere.radius);
    mask both = emits_on_both_sides(scene, id);
    mask inward = to_mask(GATHER(uints, scene->emitters, id, .u.of_sphere.inward) != 0);
    v3 f = v3_sub(view.center, from.p);
    real distance2 = v3_dot(f, f), inverse_distance = rsqrt(distance2);
    mask apart = distance2 > 0;
    view.distance = apart ? distance2 * inverse_distance : (real)(0);
    view.axis = v3_pick(apart, v3_scale(f, inverse_distance), v3_of((real)(0), (real)(0), (real)(1)));
    // A point of the sphere itself may lie on either side by rounding. Only the inside can light it.
    mask near = view.distance < view.radius + sphere_offset_of(view.center, view.radius);
    view.inside = (inward | both) ? near : view.distance < view.radius;
    view.lit = both | (inward ? view.inside : !view.inside);
    real sine = real_min(view.radius / view.distance, (real)(1));
    view.lowered = view.inside ? (real)(2) : square(sine) / (1 + sqrt((1 - sine) * (1 + sine)));
    return view;
}

// How far before the sphere shadow rays end, in half ulps of their length: a bound of the error of the next
// intersection, 1 of o - center, 1 of the ray's direction, 4 of b, 4 of c, 5 of the discriminant, 1 of the division.
#define SHADOW_END_ROUNDINGS 16

static LightSample emitter_sphere_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u, u2 bits) {
    SphereView view = sphere_seen(scene, id, from);
    Frame frame = frame_of(view.axis);
    real lowered = u.x * view.lowered, cosine = 1 - lowered, sine = sqrt(lowered * (2 - lowered));
    v2 turn = cos_sin_2pi(u.y);
    v3 d = v3_of(sine * turn.x, sine * turn.y, cosine); // in the frame
    // From the centre to the ray's nearest point, and from there half the chord along the ray.
    real across = view.distance * sine;
    real half_chord = safe_sqrt((view.radius - across) * (view.radius + across));
    v3 nearest = v3_scale(v3_of(cosine * turn.x, cosine * turn.y, -sine), across);
    v3 outward = to_world(frame, v3_normalize(v3_mad(d, view.inside ? half_chord : -half_chord, nearest)));
    if (OPAL_HAS_light_textures && OPAL_HAS_uv) {
        uints sphere = GATHER(uints, scene->emitters, id, .u.of_sphere.sphere);
        sphere = uints_pick(is_emitter(scene, id, EMITTER_sphere), sphere, (uints)(0));
        TexturePoint point = texture_point_at(sphere_uv(sphere_point(scene, sphere, outward)));
        color = textured_light(scene, id, EMITTER_sphere, color, point);
    }
    real leaves = view.distance * cosine + half_chord;
    real enters = (view.distance - view.radius) * (view.distance + view.radius) / leaves;
    real offset = sphere_offset_of(view.center, view.radius) + SHADOW_END_ROUNDINGS * EPSILON * view.distance;
    v3 end = v3_mad(outward, view.radius + (view.inside ? -offset : offset), view.center);
    return light_sample_of(to_world(frame, d), view.inside ? leaves : enters, color, 2 * PI * view.lowered, end,
                           view.lit);
}

static v3 emitter_sphere_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return color;
}

static real emitter_sphere_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    return INV_TWO_PI / sphere_seen(scene, id, from).lowered;
}
