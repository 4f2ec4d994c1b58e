// triangle: watertight ray-triangle intersection (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection").
//
// Vertices are moved to the ray's origin and sheared so that the ray becomes the axis of its largest component (kz). Their
// edge functions then have exact signs unless they are 0: rounding is monotonic, so fl(ab) > fl(cd) implies ab > cd,
// provided the two products are rounded alike: hence no contraction to fma in edge(). A zero counts as inside for both
// neighbours, so that no ray passes between two triangles that share an edge.

static real8 edge(real8 ax, real8 ay, real8 bx, real8 by) {
#pragma OPENCL FP_CONTRACT OFF
    real8 p = ax * by;
    real8 q = ay * bx;
    return p - q;
}

static real lanes_edge(real ax, real ay, real bx, real by) {
#pragma OPENCL FP_CONTRACT OFF
    real p = ax * by;
    real q = ay * bx;
    return p - q;
}

// One ray as the tree walk needs it.
typedef struct {
    real1 o[3];                           // origin
    real1 inverse[3], widened[3];         // 1 / d, finite; the same times what the rounding of a box test may be
    uint near[3], far[3];                 // where a node has the planes of its children that the ray meets first, and last
    uint kx, ky, kz;                      // axes: kz is the largest of d
    real1 sheared_o[3];                   // o[kx], o[ky], o[kz]
    real1 shear_x, shear_y, scale_z;
    real1 tmin, tmax;
} LaneRay;

// What a ray and the triangles of a block make of each other: signed sums with t = distance / determinant, and the
// barycentric weights of corners 1 and 2, b / determinant and c / determinant. Kept apart, as most need no division.
typedef struct {
    real8 distance, determinant, b, c;
    ulong hits; // bytes_of those that are hit between tmin and tmax
} BlockTest;

static BlockTest intersect_block(global const TriangleBlock *block, const LaneRay *ray) {
    global const float *x = block->vertex[0][0] + 8 * ray->kx;
    global const float *y = block->vertex[0][0] + 8 * ray->ky;
    global const float *z = block->vertex[0][0] + 8 * ray->kz;
    real1 ox = ray->sheared_o[0], oy = ray->sheared_o[1], oz = ray->sheared_o[2];
    real8 az = load8(z) - oz, bz = load8(z + 24) - oz, cz = load8(z + 48) - oz;
    real8 ax = mul_add(-ray->shear_x, az, load8(x) - ox), ay = mul_add(-ray->shear_y, az, load8(y) - oy);
    real8 bx = mul_add(-ray->shear_x, bz, load8(x + 24) - ox), by = mul_add(-ray->shear_y, bz, load8(y + 24) - oy);
    real8 cx = mul_add(-ray->shear_x, cz, load8(x + 48) - ox), cy = mul_add(-ray->shear_y, cz, load8(y + 48) - oy);
    real8 a = edge(cx, cy, bx, by), b = edge(ax, ay, cx, cy), c = edge(bx, by, ax, ay);
    mask8 inside = real8_min(a, real8_min(b, c)) >= 0 | real8_max(a, real8_max(b, c)) <= 0;

    BlockTest test;
    real8 sum = a + (b + c); // as face_test adds them, whichever corner comes first
    test.determinant = fabs(sum);
    test.distance = copysign((real8)(ray->scale_z), sum * ray->scale_z) * mul_add(a, az, mul_add(b, bz, c * cz));
    test.b = fabs(b);
    test.c = fabs(c);
    // Misses are put at the far bound and one comparison decides: clang makes bytes of three by taking each mask apart, lane by lane.
    real8 bound = ray->tmax * test.determinant;
    real8 distance = test.distance > ray->tmin * test.determinant ? test.distance : bound;
    test.hits = bytes_of((inside ? distance : bound) < bound);
    return test;
}
