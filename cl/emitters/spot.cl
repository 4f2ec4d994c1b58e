// spot: a point light that shines into a cone; only light sampling finds it. Its intensity is full up to the angle
// beamWidth from the axis and 0 from cutoffAngle on. Between them it falls in proportion to the angle (Mitsuba), or, if
// `smooth`, as the fourth power of the share of the cosine (pbrt). A texture multiplies the intensity: its unit square
// is what the cone's circle touches, on a plane across the axis.
//   <emitter type="spot"> <point name="position" value="0 3 0"/> <vector name="direction" value="0 -1 0"/>
//     <color name="intensity" value="10 10 10"/> <float name="cutoffAngle" value="30"/> </emitter>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "emitters/interface.cl"
#include "scene.cl"
#include "surface.cl"
#include "textures/dispatch.cl"
#include "textures/interface.cl"

// The angle between two unit vectors. The arc cosine would lose half of the digits near 0 and pi.
static real angle_between(v3 a, v3 b) {
    v3 difference = v3_sub(a, b), sum = v3_add(a, b);
    real difference2 = v3_dot(difference, difference), sum2 = v3_dot(sum, sum);
    mask acute = difference2 < sum2;
    real angle = 2 * asin(R(0.5) * sqrt(acute ? difference2 : sum2)); // of a and b, or of a and -b
    return acute ? angle : PI - angle;
}

// What the texture says of direction d, away from the light: 1 where there is none.
static v3 spot_texture(const Scene *scene, uints id, v3 d, v3 axis, mask active) {
    v3 across_x = GATHER_V3(scene->emitters, id, .u.of_spot.across[0]);
    v3 across_y = GATHER_V3(scene->emitters, id, .u.of_spot.across[1]);
    real depth = v3_dot(d, axis);
    v2 uv = v2_of(R(0.5) + v3_dot(d, across_x) / depth, R(0.5) + v3_dot(d, across_y) / depth);
    return texture_color(scene, GATHER(uints, scene->emitters, id, .texture), texture_point_at(uv), active);
}

static LightSample emitter_spot_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u, u2 bits) {
    v3 p = GATHER_V3(scene->emitters, id, .u.of_spot.position), to_light = v3_sub(p, from.p);
    real distance2 = v3_dot(to_light, to_light), inverse_distance = rsqrt(distance2);
    v3 d = v3_scale(to_light, inverse_distance), axis = GATHER_V3(scene->emitters, id, .u.of_spot.direction);
    real angle = angle_between(v3_scale(d, (real)(-1)), axis);
    real cutoff = GATHER(real, scene->emitters, id, .u.of_spot.cutoff_angle);
    // (cos a - cos c) / 2 = sin((c + a) / 2) sin((c - a) / 2), without cancellation
    real lowered = cos_sin_2pi((cutoff + angle) * (R(0.5) * INV_TWO_PI)).y *
                   cos_sin_2pi((cutoff - angle) * (R(0.5) * INV_TWO_PI)).y;
    mask smooth = to_mask(GATHER(uints, scene->emitters, id, .u.of_spot.smooth) != 0);
    real share = (smooth ? lowered : cutoff - angle) * GATHER(real, scene->emitters, id, .u.of_spot.inverse_transition);
    share = real_min(real_max(share, (real)(0)), (real)(1));
    real falloff = smooth ? square(square(share)) : share;
    if (OPAL_HAS_light_textures) color = v3_mul(color, spot_texture(scene, id, v3_neg(d), axis, falloff > 0));
    return light_sample_of(d, distance2 * inverse_distance, v3_scale(color, falloff * square(inverse_distance)),
                           (real)(1), p, inverse_distance < FAR & falloff > 0);
}

static v3 emitter_spot_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    return v3_all((real)(0));
}

static real emitter_spot_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    return (real)(0);
}
