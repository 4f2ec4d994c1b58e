// surface: a point where a ray met a surface, and where rays leave it. shapes/dispatch.cl finds it (surface_at).
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shared/types.h"

// A shading normal that a BSDF changed (bsdfs/perturb.cl).
typedef struct {
    v3 normal;    // before, in the frame of the BSDF that is asked
    mask shadows; // light is darkened at grazing angles to it
} Perturbation;

// The most of a nest, OPAL_PERTURBATIONS, but no array may be empty.
#define PERTURBATION_PLACES (OPAL_PERTURBATIONS > 0 ? OPAL_PERTURBATIONS : 1)

typedef struct {
    v3 p;                // position
    real t, u, v;        // its distance along the ray, and its coordinates (Hit)
    v2 uv;               // texture coordinates, where the kernel has the feature uv
    v3 dpdu, dpdv;       // derivatives of p over uv, flattened units; unset unless the kernel has the feature tangents
    v3 normal;           // geometric, unit, on the outer side: of triangles that of (p1-p0) x (p2-p0)
    Frame frame;         // around the shading normal
    v3 wi;               // towards the ray's origin, unit, in that frame
    uints primitive;     // its id (row `id` of blocks): of triangles the index
    real ray_offset;     // how far above the surface rays start (ray_offset_of)
    uints bsdf;          // first word of the BSDF's record
    uints emitter;       // index, OPAL_NONE where the surface does not emit
    real opacity;        // the probability that light meets the BSDF (bsdf_open); of kernels with masks
    Perturbation perturbations[PERTURBATION_PLACES]; // the inmost first (bsdf_open)
} Surface;

static Surface surface_pick(mask m, Surface yes, Surface no) {
    Frame frame = {v3_pick(m, yes.frame.s, no.frame.s), v3_pick(m, yes.frame.t, no.frame.t),
                   v3_pick(m, yes.frame.n, no.frame.n)};
    Surface s = {v3_pick(m, yes.p, no.p), m ? yes.t : no.t, m ? yes.u : no.u, m ? yes.v : no.v,
                 v2_of(m ? yes.uv.x : no.uv.x, m ? yes.uv.y : no.uv.y), v3_pick(m, yes.dpdu, no.dpdu),
                 v3_pick(m, yes.dpdv, no.dpdv), v3_pick(m, yes.normal, no.normal), frame,
                 v3_pick(m, yes.wi, no.wi),
                 uints_pick(m, yes.primitive, no.primitive), m ? yes.ray_offset : no.ray_offset,
                 uints_pick(m, yes.bsdf, no.bsdf), uints_pick(m, yes.emitter, no.emitter), (real)(1)};
    return s;
}

// All zero, of no emitter: valid for lanes that hit nothing.
static Surface no_surface(void) {
    v3 zero = v3_all((real)(0));
    Frame frame = {zero, zero, zero};
    Surface s = {zero, (real)(0), (real)(0), (real)(0), v2_of((real)(0), (real)(0)), zero, zero, zero, frame, zero,
                 (uints)(0), (real)(0), (uints)(0), (uints)(OPAL_NONE), (real)(1)};
    return s;
}

// The frame around the unit vector n whose s is the tangent dpdu of a Surface made orthogonal to n, as Mitsuba has it;
// t = n x s. Where dpdu is 0, as at the poles of spheres, or all but along n, s is some vector across n.
#define TANGENT_LEAST R(1e-3) // the sine of the angle between n and dpdu: below, rounding tilts s by 1e-4
static Frame tangent_frame(v3 n, v3 dpdu) {
    v3 along = v3_scale(dpdu, 1 / v3_largest(v3_abs(dpdu))); // its square would overflow
    v3 s = v3_mad(n, -v3_dot(n, along), along);
    real length2 = v3_dot(s, s);
    mask valid = length2 > TANGENT_LEAST * TANGENT_LEAST;
    s = v3_pick(valid, v3_scale(s, rsqrt(length2)), frame_with_jump(n, (real)(0)).s);
    Frame frame = {s, v3_cross(n, s), n};
    return frame;
}

// Sets what follows from the shading normal and the mesh: frame, wi, BSDF and emitter. ray.d is unit but for rounding,
// which would add up in glass and mirrors: one Newton step towards 1 / sqrt(d.d) removes it from wi.
static void finish_surface(const Scene *scene, Ray ray, v3 shading_normal, uints mesh, Surface *s) {
    s->frame = OPAL_HAS_tangents ? tangent_frame(shading_normal, s->dpdu) : frame_of(shading_normal);
    s->wi = to_local(s->frame, v3_scale(ray.d, R(-1.5) + R(0.5) * v3_dot(ray.d, ray.d)));
    s->bsdf = GATHER(uints, scene->meshes, mesh, .bsdf);
    s->emitter = GATHER(uints, scene->meshes, mesh, .emitter);
}

// The distance above a triangle at which rays start: it bounds the error of a point on the triangle along the normal,
// plus that of the next intersection, so that the triangle is met on the right side or not at all. In half ulps of the
// largest coordinate, the point p0 + u e1 + v e2 has an error of 6 a coordinate (edges 2, products 2, sums 2), sqrt(3)
// times that along the normal; the next intersection moves and shears the vertices with about the same: 12 sqrt(3),
// rounded up. They are ulps of floats in double precision too, because the scene is made of floats: the two triangles
// of a parallelogram are not quite in one plane, and in double half of a lamp would hide behind the other half.
#define RAY_OFFSET_ROUNDINGS 24
#define FLOAT_HALF_ULP R(5.9604645e-08)
static real ray_offset_of(v3 p0, v3 p1, v3 p2) {
    real largest = real_max(v3_largest(v3_abs(p0)), real_max(v3_largest(v3_abs(p1)), v3_largest(v3_abs(p2))));
    return RAY_OFFSET_ROUNDINGS * FLOAT_HALF_ULP * largest;
}

// Where a ray starts that leaves the surface in direction d: the ray offset above p, on d's side.
static v3 leave_surface(const Surface *s, v3 d) {
    real side = copysign(s->ray_offset, v3_dot(s->normal, d));
    return v3_mad(s->normal, side, s->p);
}
