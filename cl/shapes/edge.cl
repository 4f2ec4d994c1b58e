// edge: the edge function of watertight ray-triangle intersection (Woop, Benthin and Wald 2013, "Watertight
// Ray/Triangle Intersection"). one_lane/ and many_lanes/ test the tree's triangles by it, trace/faces.cl
// those of the face list.
//
// Vertices are moved to the ray's origin and sheared so that the ray becomes the axis of its largest component (kz).
// Their edge functions then have exact signs unless they are 0: rounding is monotonic, so fl(ab) > fl(cd) implies ab >
// cd, as long as both products are rounded alike. Hence no contraction to fma in edge(). A zero counts as inside for
// both neighbours, so that no ray passes between two triangles that share an edge.
#include "core/lanes.cl"
#include "shapes/list.h"
#include "shared/types.h"

// Offset in floats, from the coordinates of a block's corner 0, of those of corner c on the same axis (TriangleBlock).
#define CORNER(c) ((c) * 3 * OPAL_WIDTH)

static real edge(real ax, real ay, real bx, real by) {
#pragma OPENCL FP_CONTRACT OFF
    real p = ax * by;
    real q = ay * bx;
    return p - q;
}
