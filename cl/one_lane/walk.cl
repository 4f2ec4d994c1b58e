// one_lane/walk: closest and any hit of one ray, for kernels that carry one lane, as GPUs run them. It takes the place of bvh.cl's walks.
//
// A GPU keeps a work-item's values in registers and has few of them; an array that is indexed by a variable lies in memory. So the ray is
// held in scalars, what waits at a level is 8 bytes, and one walk serves both kinds of rays. Structure: Aila and Laine 2009, "Understanding
// the Efficiency of Ray Traversal on GPUs" (while-while: down to a leaf, then its triangles); children in the order of their distance: as
// bvh.cl, so that both meet the same triangles.
#if OPAL_DOUBLE
typedef double4 real4;
#define real4_of(x) convert_double4(x)
#else
typedef float4 real4;
#define real4_of(x) (x)
#endif

// The children of a node that a ray meets and has not taken, nearest first: the places of three bits each, the next one lowest, and above
// the last a 1.
#define NO_CHILDREN 1u

// The ray, and the children of the root that it meets.
typedef struct {
    LaneRay ray;
    uint order, walking;
} WalkRay;

// Puts the lesser of two keys first.
#define IN_ORDER(a, b) { key1 less = min(a, b); b = max(a, b); a = less; }

// The keys of four children that lie side by side, from `place` on; counts those that are met. A plane's row of four is one 128-bit load.
// (plane - o) / d loses nothing that matters, and the far side is widened by its error bound, so that no box misses a triangle inside it
// (Ize 2013, "Robust BVH Ray Traversal"). fmax and fmin drop NaN; tmin last, by a comparison, so that no key is made of -0.
#define KEYS_OF_FOUR(planes, r, tmax, place, k0, k1, k2, k3, count) { \
    real4 x = (real4_of(planes[(r)->near[0] / 4 + place / 4]) - (r)->o[0]) * (r)->inverse[0]; \
    real4 y = (real4_of(planes[(r)->near[1] / 4 + place / 4]) - (r)->o[1]) * (r)->inverse[1]; \
    real4 z = (real4_of(planes[(r)->near[2] / 4 + place / 4]) - (r)->o[2]) * (r)->inverse[2]; \
    real4 enter = fmax(fmax(x, y), z); \
    x = (real4_of(planes[(r)->far[0] / 4 + place / 4]) - (r)->o[0]) * (r)->widened[0]; \
    y = (real4_of(planes[(r)->far[1] / 4 + place / 4]) - (r)->o[1]) * (r)->widened[1]; \
    z = (real4_of(planes[(r)->far[2] / 4 + place / 4]) - (r)->o[2]) * (r)->widened[2]; \
    real4 leave = fmin(fmin(x, y), fmin(z, (real4)(tmax))); \
    KEY_OF_ONE(r, enter.x, leave.x, place, k0, count) \
    KEY_OF_ONE(r, enter.y, leave.y, place + 1, k1, count) \
    KEY_OF_ONE(r, enter.z, leave.z, place + 2, k2, count) \
    KEY_OF_ONE(r, enter.w, leave.w, place + 3, k3, count) \
}
#define KEY_OF_ONE(r, enter, leave, place, key, count) { \
    real1 from = enter > (r)->tmin ? enter : (r)->tmin; \
    key = from <= leave ? (key_of(from) & ~KEYS_PLACE) | (place) : NO_KEY; \
    count += from <= leave; \
}

// Which children of a node the ray meets before tmax, in the order in which it enters them.
static uint children_in_order(global const BvhNode *node, const LaneRay *r, real1 tmax) {
    global const float4 *planes = (global const float4 *)node->lo[0]; // and after it node->hi; nodes are 16-byte aligned
    key1 a, b, c, d, e, f, g, h;
    uint count = 0;
    KEYS_OF_FOUR(planes, r, tmax, 0, a, b, c, d, count)
    KEYS_OF_FOUR(planes, r, tmax, 4, e, f, g, h, count)

    // Batcher's odd-even merge sort of eight: 19 comparisons
    IN_ORDER(a, b) IN_ORDER(c, d) IN_ORDER(e, f) IN_ORDER(g, h)
    IN_ORDER(a, c) IN_ORDER(b, d) IN_ORDER(e, g) IN_ORDER(f, h)
    IN_ORDER(b, c) IN_ORDER(f, g)
    IN_ORDER(a, e) IN_ORDER(b, f) IN_ORDER(c, g) IN_ORDER(d, h)
    IN_ORDER(c, e) IN_ORDER(d, f)
    IN_ORDER(b, c) IN_ORDER(d, e) IN_ORDER(f, g)

    uint order = (uint)(a & KEYS_PLACE) | (uint)(b & KEYS_PLACE) << 3 | (uint)(c & KEYS_PLACE) << 6 | (uint)(d & KEYS_PLACE) << 9 |
                 (uint)(e & KEYS_PLACE) << 12 | (uint)(f & KEYS_PLACE) << 15 | (uint)(g & KEYS_PLACE) << 18 | (uint)(h & KEYS_PLACE) << 21;
    uint end = 1u << 3 * count; // those that are not met have the greatest keys and stand behind it
    return (order & (end - 1)) | end;
}

static void store_ray(WalkRay *w, const Scene *scene, Ray ray, mask live) {
    v3 inverse = v3_of(safe_inverse(ray.d.x), safe_inverse(ray.d.y), safe_inverse(ray.d.z));
    v3 widened = v3_scale(inverse, 1 + 8 * EPSILON);
    Shear s = shear_with(ray.d, inverse);
    uint kz = s.x ? 0 : s.y ? 1 : 2, kx = s.x ? 1 : s.y ? 2 : 0;
    uint near_x = inverse.x < 0 ? 24 : 0, near_y = inverse.y < 0 ? 32 : 8, near_z = inverse.z < 0 ? 40 : 16; // rows of BvhNode::lo and hi
    LaneRay r = {
        {ray.o.x, ray.o.y, ray.o.z}, {inverse.x, inverse.y, inverse.z}, {widened.x, widened.y, widened.z},
        {near_x, near_y, near_z}, {24 - near_x, 40 - near_y, 56 - near_z}, kx, 3 - kx - kz, kz,
        {s.x ? ray.o.y : s.y ? ray.o.z : ray.o.x, s.x ? ray.o.z : s.y ? ray.o.x : ray.o.y, s.x ? ray.o.x : s.y ? ray.o.y : ray.o.z},
        s.shear_x, s.shear_y, s.scale_z, ray.tmin, ray.tmax};
    w->ray = r;
    w->order = children_in_order(scene->nodes, &r, ray.tmax);
    w->walking = live && !isnan(s.shear_x + s.shear_y + ray.o.x + ray.o.y + ray.o.z) && w->order != NO_CHILDREN; // NaN would meet every box
}

// What the ray and triangle `i` of a block make of each other, as intersect_block does for all eight (triangle.cl).
typedef struct { real1 distance, determinant, b, c; bool inside; } TriangleTest;

static TriangleTest intersect_triangle(global const TriangleBlock *block, uint i, const LaneRay *r) {
    global const float *x = block->vertex[0][r->kx] + i, *y = block->vertex[0][r->ky] + i, *z = block->vertex[0][r->kz] + i;
    real1 az = z[0] - r->sheared_o[2], bz = z[24] - r->sheared_o[2], cz = z[48] - r->sheared_o[2];
    real1 ax = mul_add(-r->shear_x, az, x[0] - r->sheared_o[0]), ay = mul_add(-r->shear_y, az, y[0] - r->sheared_o[1]);
    real1 bx = mul_add(-r->shear_x, bz, x[24] - r->sheared_o[0]), by = mul_add(-r->shear_y, bz, y[24] - r->sheared_o[1]);
    real1 cx = mul_add(-r->shear_x, cz, x[48] - r->sheared_o[0]), cy = mul_add(-r->shear_y, cz, y[48] - r->sheared_o[1]);
    real1 a = lanes_edge(cx, cy, bx, by), b = lanes_edge(ax, ay, cx, cy), c = lanes_edge(bx, by, ax, ay);
    real1 sum = a + (b + c);
    TriangleTest test = {copysign(r->scale_z, sum * r->scale_z) * mul_add(a, az, mul_add(b, bz, c * cz)), fabs(sum), fabs(b), fabs(c),
                         fmin(a, fmin(b, c)) >= 0 || fmax(a, fmax(b, c)) <= 0};
    return test;
}

// Whether the ray hits a triangle of the block before its tmax; the nearest one is noted unless `any` will do.
static bool hit_block(const Scene *scene, LaneRay *r, uint block, bool any, LaneHits *hits) {
    COUNT_TESTS(scene, blocks, 1);
    global const TriangleBlock *triangles = scene->blocks + block;
    real1 tmax = r->tmax; // of all eight, as intersect_block has it
    bool hit = false;
#pragma unroll 1
    for (uint i = 0; i < 8 && triangles->id[i] != OPAL_NONE; i++) { // unused places come last
        TriangleTest test = intersect_triangle(triangles, i, r);
        if (!test.inside || !(test.distance > r->tmin * test.determinant) || !(test.distance < tmax * test.determinant)) continue;
        if (any) return true;
        real1 reciprocal = 1 / test.determinant, t = test.distance * reciprocal;
        if (!(t < r->tmax)) continue;
        hit = true;
        hits->t[0] = r->tmax = t;
        hits->u[0] = test.b * reciprocal;
        hits->v[0] = test.c * reciprocal;
        hits->slot[0] = block * 8 + i;
    }
    return hit;
}

// Walks to the nearest hit, which `hits` takes, or to any; returns whether there is one.
static bool walk_one(const Scene *scene, const WalkRay *w, bool any, LaneHits *hits) {
    LaneRay r = w->ray;
    uint node_above[OPAL_LEVELS], order_above[OPAL_LEVELS]; // nodes with children left, and those
    uint top = 0, node = 0, order = w->order;
    bool hit = false;
    for (;;) {
        uint child;
        for (;;) { // down to the next leaf
            if (order == NO_CHILDREN) {
                if (top == 0) return hit;
                top--;
                node = node_above[top];
                order = order_above[top];
            }
            child = scene->nodes[node].child[order & KEYS_PLACE];
            order >>= 3;
            if (child & OPAL_LEAF) break;
            if (order != NO_CHILDREN) {
                node_above[top] = node;
                order_above[top] = order;
                top++;
            }
            COUNT_TESTS(scene, nodes, 1);
            node = child;
            order = children_in_order(scene->nodes + node, &r, r.tmax);
        }
        hit = hit_block(scene, &r, child & ~OPAL_LEAF, any, hits) || hit;
        if (any && hit) return true;
    }
}

static void walk_one_closest(const Scene *scene, const WalkRay *w, LaneHits *hits) { walk_one(scene, w, false, hits); }
static uint walk_one_any(const Scene *scene, const WalkRay *w) {
    LaneHits hits; // stays empty
    return walk_one(scene, w, true, &hits);
}

// closest_hit and blocked_by take these
#define LaneRays WalkRay
#define store_rays store_ray
#define walk_closest walk_one_closest
#define walk_any walk_one_any
