// one_lane/triangle: one ray against one triangle of a block, as many_lanes/ does for all eight.
#include "core/lanes.cl"
#include "shapes/edge.cl"
#include "shapes/interface.cl"
#include "shapes/list.h"
#include "shared/types.h"

// Distances and weights are signed sums.
static BlockTest intersect_triangle(global const TriangleBlock *block, uint i, const LaneRay *r) {
    real1 ox = r->sheared_o[0], oy = r->sheared_o[1], oz = r->sheared_o[2];
    // One pointer an axis: nine addresses by kx, ky and kz would take 20 registers more on NVIDIA.
    global const float *x = block->vertex[0][r->kx] + i, *y = block->vertex[0][r->ky] + i;
    global const float *z = block->vertex[0][r->kz] + i;
    real1 az = z[CORNER(0)] - oz, bz = z[CORNER(1)] - oz, cz = z[CORNER(2)] - oz;
    real1 ax = mul_add(-r->shear_x, az, x[CORNER(0)] - ox), ay = mul_add(-r->shear_y, az, y[CORNER(0)] - oy);
    real1 bx = mul_add(-r->shear_x, bz, x[CORNER(1)] - ox), by = mul_add(-r->shear_y, bz, y[CORNER(1)] - oy);
    real1 cx = mul_add(-r->shear_x, cz, x[CORNER(2)] - ox), cy = mul_add(-r->shear_y, cz, y[CORNER(2)] - oy);
    real1 a = edge(cx, cy, bx, by), b = edge(ax, ay, cx, cy), c = edge(bx, by, ax, ay);
    real1 sum = a + (b + c);
    real1 distance = copysign(r->scale_z, sum * r->scale_z) * mul_add(a, az, mul_add(b, bz, c * cz));
    BlockTest test = {distance, fabs(sum), fabs(b), fabs(c),
                      fmin(a, fmin(b, c)) >= 0 || fmax(a, fmax(b, c)) <= 0};
    return test;
}
