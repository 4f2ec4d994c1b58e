// sphere: exact spheres.
//   <mesh type="sphere"> <point name="center" value="0 0 0"/> <float name="radius" value="1"/> </mesh>
//
// With f = o - center, the ray o + t d meets the sphere where a t^2 + 2 b t + c = 0, a = d.d, b = f.d, c = f.f - r^2.
// b^2 - a c would lose all digits where the sphere is small or far. It is computed as a r^2 - |f x d|^2, and the roots
// as q / a and c / q, q = -b -+ sqrt(b^2 - a c), which do not cancel either (Haines et al. 2019, "Precision
// Improvements for Ray/Sphere Intersection", Ray Tracing Gems, chapter 7).
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shapes/interface.cl"
#include "shapes/list.h"
#include "shared/types.h"
#include "surface.cl"
#if LANES == 1
#include "shapes/one_lane/places.cl"
#else
#include "shapes/many_lanes/places.cl"
#endif

// BlockTest's coordinate u is 1 where the ray leaves the sphere, 0 where it enters it. d is (shear_x, shear_y, 1) along
// kx, ky, kz here, turned to the ray's direction.
static BlockTest intersect_sphere(global const SphereBlock *block, uint place, const LaneRay *ray) {
    real1 shear_x = ray->shear_x, shear_y = ray->shear_y, unit = fabs(ray->scale_z);
    real1 a = mul_add(shear_x, shear_x, mul_add(shear_y, shear_y, (real1)(1)));
    places x = ray->sheared_o[0] - load_places(block->center[ray->kx] + place);
    places y = ray->sheared_o[1] - load_places(block->center[ray->ky] + place);
    places z = ray->sheared_o[2] - load_places(block->center[ray->kz] + place);
    places radius = load_places(block->radius + place);
    places sheared_x = mul_add(-shear_x, z, x), sheared_y = mul_add(-shear_y, z, y);
    places cross_z = sheared_x * shear_y - sheared_y * shear_x; // those of x and y are sheared_y and -sheared_x
    places discriminant = a * radius * radius -
                          mul_add(sheared_x, sheared_x, mul_add(sheared_y, sheared_y, cross_z * cross_z));
    places b = mul_add(sheared_x, (places)(shear_x), mul_add(sheared_y, (places)(shear_y), a * z));
    b = b * copysign((real1)(1), ray->scale_z);
    places c = mul_add(x, x, mul_add(y, y, z * z)) - radius * radius;
    place_mask inside = discriminant > 0;
    places q = fabs(b) + sqrt(inside ? discriminant : (places)(0));
    // Where b > 0 the ray enters behind its origin.
    place_mask receding = b > 0, far = receding | !(c * unit > ray->tmin * q);
    BlockTest test;
    test.distance = (receding ? -c : far ? q : c) * unit;
    test.determinant = (far & !receding) ? (places)(a) : q;
    test.b = far ? test.determinant : (places)(0);
    test.c = 0;
    test.inside = inside;
    return test;
}

// The distance above a sphere at which rays start, as ray_offset_of of triangles. In half ulps, a point center + radius
// normal has an error of 2 of its largest coordinate, sqrt(3) rounded up, by the sum, and as much again where the
// ray's start is rounded. All else is relative to the radius: 6 for the normal's length and the product; in the next
// intersection 1 for o - center, 4 for c, 5 for the discriminant.
#define SPHERE_OFFSET_POSITION 4
#define SPHERE_OFFSET_RADIUS 16
static real sphere_offset_of(v3 center, real radius) {
    real largest = v3_largest(v3_abs(center)) + radius;
    return EPSILON * (SPHERE_OFFSET_POSITION * largest + SPHERE_OFFSET_RADIUS * radius);
}

// A point of spheres in texture coordinates, from its unit vector `outward` from the centre. In the sphere's own frame
// u is the angle around z from x over 2 pi, in [0, 1), and v the angle from z over pi. `sphere`: its index
typedef struct {
    v3 own;          // outward, in the sphere's own frame
    v3 axis[3];      // that frame
    real across;     // the distance from its z axis
} SpherePoint;

static SpherePoint sphere_point(const Scene *scene, uints sphere, v3 outward) {
    SpherePoint point;
    point.axis[0] = GATHER_V3(scene->sphere_frames, sphere, .axis[0]);
    point.axis[1] = GATHER_V3(scene->sphere_frames, sphere, .axis[1]);
    point.axis[2] = GATHER_V3(scene->sphere_frames, sphere, .axis[2]);
    point.own = v3_of(v3_dot(point.axis[0], outward), v3_dot(point.axis[1], outward), v3_dot(point.axis[2], outward));
    point.across = sqrt(sin2_theta(point.own));
    return point;
}

static v2 sphere_uv(SpherePoint point) {
    // acos(z) would lose half of the digits near the poles.
    real u = atan2(point.own.y, point.own.x) * INV_TWO_PI, v = atan2(point.across, point.own.z) * INV_PI;
    return v2_of(u < 0 ? real_min(u + 1, (real)(1 - EPSILON)) : u, v);
}

// Sets dpdu and dpdv. At a pole dpdu is 0, and dpdv is along x, as Mitsuba has it.
static void set_sphere_tangents(SpherePoint point, real radius, Surface *s) {
    mask pole = !(point.across > 0);
    real inverse = pole ? (real)(0) : 1 / point.across;
    real cosine = pole ? (real)(1) : point.own.x * inverse * point.own.z, sine = point.own.y * inverse * point.own.z;
    v3 dpdu = v3_mad(point.axis[1], point.own.x, v3_scale(point.axis[0], -point.own.y));
    v3 dpdv = v3_mad(point.axis[0], cosine, v3_mad(point.axis[1], sine, v3_scale(point.axis[2], -point.across)));
    s->dpdu = v3_scale(dpdu, 2 * PI * radius);
    s->dpdv = v3_scale(dpdv, PI * radius);
}

static Surface surface_of_sphere(const Scene *scene, Ray ray, Hit hit, mask active) {
    uints word = WORD_OF_PLACE(SphereBlock, uints_pick(active, hit.place, (uints)(0)));
    // Pointers to words: beyond the first block they lie past the row, where no array may be indexed.
    global const float *first = scene->sphere_blocks->center[0];
    global const uint *flags = scene->sphere_blocks->inward;
    v3 center = v3_of(GATHER_WORD(real, first, word), GATHER_WORD(real, (first + OPAL_WIDTH), word),
                      GATHER_WORD(real, (first + 2 * OPAL_WIDTH), word));
    real radius = GATHER_WORD(real, (first + 3 * OPAL_WIDTH), word);
    mask inward = to_mask(GATHER_WORD(uints, flags, word) != 0);
    uints mesh = GATHER_WORD(uints, (flags + OPAL_WIDTH), word);

    // From the centre to the ray's nearest point, and from there along the ray. o + t d would be off by the rounding of
    // t, which may be more than the radius. The rest of f along d is taken off twice, as the first time rounds.
    v3 f = v3_sub(ray.o, center);
    real inverse_a = 1 / v3_dot(ray.d, ray.d);
    v3 across = v3_mad(ray.d, -v3_dot(f, ray.d) * inverse_a, f);
    across = v3_mad(ray.d, -v3_dot(across, ray.d) * inverse_a, across);
    real across2 = v3_dot(across, across), radius2 = radius * radius;
    across = v3_scale(across, across2 > radius2 ? radius * rsqrt(across2) : (real)(1));
    real along = safe_sqrt((radius2 - across2) * inverse_a);
    v3 outward = v3_normalize(v3_mad(ray.d, hit.u > R(0.5) ? along : -along, across));

    Surface s;
    s.normal = v3_pick(inward, v3_neg(outward), outward);
    s.primitive = GATHER_WORD(uints, (flags + 2 * OPAL_WIDTH), word);
    s.ray_offset = sphere_offset_of(center, radius);
    s.t = hit.t;
    s.u = hit.u;
    s.v = hit.v;
    s.uv = v2_of((real)(0), (real)(0));
    if (OPAL_HAS_uv) {
        SpherePoint point = sphere_point(scene, s.primitive & (uint)(OPAL_BLOCK_BITS), outward);
        s.uv = sphere_uv(point);
        if (OPAL_HAS_tangents) set_sphere_tangents(point, radius, &s);
    }
    s.p = v3_mad(outward, radius, center);
    finish_surface(scene, ray, s.normal, mesh, &s);
    return s;
}
