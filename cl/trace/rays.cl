// rays: the set-up of a ray for both walks of the tree (one_lane/, many_lanes/).
#include "core/lanes.cl"
#include "shapes/dispatch.cl"
#include "shared/types.h"

// The axis kz of the largest component of d, and the shear that turns d into that axis (shapes/edge.cl).
typedef struct {
    mask x, y;                      // kz = 0, kz = 1; else 2
    real shear_x, shear_y, scale_z; // d[kx] / d[kz], d[ky] / d[kz], 1 / d[kz], with kx = kz + 1, ky = kz + 2 mod 3
} Shear;

// The shear of d, given 1 / d.
static Shear shear_with(v3 d, v3 inverse) {
    v3 a = v3_abs(d);
    Shear s;
    s.x = a.x > a.y & a.x > a.z;
    s.y = (a.y > a.z) & (a.y >= a.x);
    s.scale_z = s.x ? inverse.x : s.y ? inverse.y : inverse.z;
    s.shear_x = (s.x ? d.y : s.y ? d.z : d.x) * s.scale_z;
    s.shear_y = (s.x ? d.z : s.y ? d.x : d.y) * s.scale_z;
    return s;
}

// The shear of d, by one division: that by the largest component.
static Shear shear_of(v3 d) {
    Shear s = shear_with(d, d);
    return shear_with(d, v3_all(1 / s.scale_z));
}

// 1/d, finite also for zeros, whose sign is kept: a box test then never meets 0 * inf.
#define LEAST_DIVISOR R(1e-30)
static real safe_inverse(real d) {
    return 1 / (fabs(d) < LEAST_DIVISOR ? copysign((real)(LEAST_DIVISOR), d) : d);
}

// Relative widening of the far distance of a box, so that rounding makes no box miss a triangle inside it: the distance
// (plane - o) * (1 / d) has three roundings, on the near and on the far side, 6 half ulps in all (Ize 2013, "Robust BVH
// Ray Traversal": 2 gamma_3); 2 more for the widening itself.
#define BOX_WIDENING (1 + 8 * EPSILON)

// Offsets in floats, from BvhNode::lo on, of the children's lower and upper planes of an axis; OPPOSITE_PLANES turns
// either into the other.
#define LOWER_PLANES(axis) (OPAL_WIDTH * (axis))
#define UPPER_PLANES(axis) (OPAL_WIDTH * (3 + (axis)))
#define OPPOSITE_PLANES(axis, planes) (LOWER_PLANES(axis) + UPPER_PLANES(axis) - (planes))

// A key orders a node's children by where a ray enters them: the bits of that distance, which compare as the (positive)
// distance does, with the child's place in the last three bits. NO_KEY: the ray misses the child.
#define KEY_PLACE_BITS 3
#define KEY_PLACE 7

// The nearest hits of all lanes. shape: unset in kernels of one shape
typedef struct {
    real1 t[LANES], u[LANES], v[LANES];
    uint shape[LANES], place[LANES];
} LaneHits;

// Sets the hit of one lane but for t, u and v: the primitive in `place` of the leaf `child`.
static void set_primitive(LaneHits *hits, int lane, uint child, uint place) {
    if (SHAPE_KINDS > 1) hits->shape[lane] = leaf_shape(child);
    hits->place[lane] = leaf_block(child) * OPAL_WIDTH + place;
}
