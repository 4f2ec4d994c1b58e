// triangle: watertight ray-triangle intersection (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection").
//
// Vertices are moved to the ray's origin and sheared so that the ray becomes the axis of its largest component (kz). Their
// edge functions then have exact signs unless they are 0: rounding is monotonic, so fl(ab) > fl(cd) implies ab > cd,
// provided the two products are rounded alike: hence no contraction to fma in edge(). A zero counts as inside for both
// neighbours, so that no ray passes between two triangles that share an edge.

real8 edge(real8 ax, real8 ay, real8 bx, real8 by) {
#pragma OPENCL FP_CONTRACT OFF
    real8 p = ax * by;
    real8 q = ay * bx;
    return p - q;
}

real lanes_edge(real ax, real ay, real bx, real by) {
#pragma OPENCL FP_CONTRACT OFF
    real p = ax * by;
    real q = ay * bx;
    return p - q;
}

// One ray as the tree walk needs it.
typedef struct {
    real1 o[3];            // origin
    real1 shear_x, shear_y, scale_z;
    int kx, ky, kz;        // axes: kz is the largest of d
    real1 inverse[3];      // 1 / d, finite
    real1 tmin, tmax;
} LaneRay;

// The block's triangles that the ray hits, one bit a place, with their distances and barycentric weights of corners 1, 2.
uint intersect_block(global const TriangleBlock *block, const LaneRay *ray, real8 *t, real8 *u, real8 *v) {
    global const float *x = block->vertex[0][0] + 8 * ray->kx;
    global const float *y = block->vertex[0][0] + 8 * ray->ky;
    global const float *z = block->vertex[0][0] + 8 * ray->kz;
    real1 ox = ray->o[ray->kx], oy = ray->o[ray->ky], oz = ray->o[ray->kz];
    real8 az = load8(z) - oz, bz = load8(z + 24) - oz, cz = load8(z + 48) - oz;
    real8 ax = mad(-ray->shear_x, az, load8(x) - ox), ay = mad(-ray->shear_y, az, load8(y) - oy);
    real8 bx = mad(-ray->shear_x, bz, load8(x + 24) - ox), by = mad(-ray->shear_y, bz, load8(y + 24) - oy);
    real8 cx = mad(-ray->shear_x, cz, load8(x + 48) - ox), cy = mad(-ray->shear_y, cz, load8(y + 48) - oy);
    real8 a = edge(cx, cy, bx, by), b = edge(ax, ay, cx, cy), c = edge(bx, by, ax, ay);
    real8 determinant = a + b + c;
    real8 reciprocal = 1 / determinant;
    *t = ray->scale_z * mad(a, az, mad(b, bz, c * cz)) * reciprocal;
    *u = b * reciprocal;
    *v = c * reciprocal;
    mask8 inside = real8_min(a, real8_min(b, c)) >= 0 | real8_max(a, real8_max(b, c)) <= 0;
    return bits_of(inside & (determinant != 0) & (*t > ray->tmin) & (*t < ray->tmax));
}
