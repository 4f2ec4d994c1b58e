// many_lanes/triangle: one ray against the eight triangles of a block, in one vector.
#include "core/lanes.cl"
#include "core/many_lanes/eight_wide.cl"
#include "shapes/edge.cl"
#include "shapes/interface.cl"
#include "shapes/list.h"
#include "shared/types.h"

// As edge() in shapes/edge.cl.
static real8 edge8(real8 ax, real8 ay, real8 bx, real8 by) {
#pragma OPENCL FP_CONTRACT OFF
    real8 p = ax * by;
    real8 q = ay * bx;
    return p - q;
}

// Distances and weights are signed sums.
static BlockTest intersect_triangle(global const TriangleBlock *block, uint place, const LaneRay *ray) {
    global const float *x = block->vertex[0][ray->kx], *y = block->vertex[0][ray->ky], *z = block->vertex[0][ray->kz];
    real1 ox = ray->sheared_o[0], oy = ray->sheared_o[1], oz = ray->sheared_o[2];
    real8 az = load8(z + CORNER(0)) - oz, bz = load8(z + CORNER(1)) - oz, cz = load8(z + CORNER(2)) - oz;
    real8 ax = mul_add(-ray->shear_x, az, load8(x + CORNER(0)) - ox);
    real8 ay = mul_add(-ray->shear_y, az, load8(y + CORNER(0)) - oy);
    real8 bx = mul_add(-ray->shear_x, bz, load8(x + CORNER(1)) - ox);
    real8 by = mul_add(-ray->shear_y, bz, load8(y + CORNER(1)) - oy);
    real8 cx = mul_add(-ray->shear_x, cz, load8(x + CORNER(2)) - ox);
    real8 cy = mul_add(-ray->shear_y, cz, load8(y + CORNER(2)) - oy);
    real8 a = edge8(cx, cy, bx, by), b = edge8(ax, ay, cx, cy), c = edge8(bx, by, ax, ay);

    BlockTest test;
    real8 sum = a + (b + c); // in the order of face_test, whichever corner comes first
    test.determinant = fabs(sum);
    test.distance = copysign((real8)(ray->scale_z), sum * ray->scale_z) * mul_add(a, az, mul_add(b, bz, c * cz));
    test.b = fabs(b);
    test.c = fabs(c);
    test.inside = real8_min(a, real8_min(b, c)) >= 0 | real8_max(a, real8_max(b, c)) <= 0;
    return test;
}
