// one_lane/walk: closest and any hit of one ray in the tree, for kernels that carry one lane, as GPUs run them.
//
// A GPU keeps a work-item's values in registers, of which it has few; an array that is indexed by a variable lies in
// memory. So the ray is held in scalars, each level of the stack takes 8 bytes, and one walk serves both kinds of rays.
// The loops are those of Aila and Laine 2009, "Understanding the Efficiency of Ray Traversal on GPUs" (while-while:
// down to a leaf, then its primitives). Children are visited in the order of their distance, as many_lanes/walk.cl
// does, so that both meet the same primitives.
#include "core/lanes.cl"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "shapes/interface.cl"
#include "shared/counters.h"
#include "shared/types.h"
#include "trace/rays.cl"

#if OPAL_DOUBLE
typedef double4 real4;
#define real4_of(x) convert_double4(x)
#else
typedef float4 real4;
#define real4_of(x) (x)
#endif

// The children of a node that a ray meets and has not visited, as a list in one word, nearest first: three bits a
// child, the next one lowest, and a 1 above the last.
#define NO_CHILDREN 1u

// The ray, and the children of the root that it meets.
typedef struct {
    LaneRay ray;
    uint order, walking; // order: these children as a list; walking: 1 where there are any, else 0
} TreeRays;

// Puts the lesser of two keys first.
#define IN_ORDER(a, b) { key1 less = min(a, b); b = max(a, b); a = less; }

// The keys of four neighbouring children, from `place` on; counts those that are met. Four planes are one 128-bit load.
// fmax and fmin drop NaN. tmin comes last, by a comparison, so that no key is made of -0.
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
    key = from <= leave ? (key_of(from) & ~KEY_PLACE) | (place) : NO_KEY; \
    count += from <= leave; \
}

// The child of a key as item i of a list.
#define CHILD(key, i) ((uint)((key) & KEY_PLACE) << KEY_PLACE_BITS * (i))

// The children of a node that the ray meets before tmax, as a list.
static uint children_in_order(global const BvhNode *node, const LaneRay *r, real1 tmax) {
    global const float4 *planes = (global const float4 *)node->lo[0]; // then node->hi; nodes are 16-byte aligned
    key1 a, b, c, d, e, f, g, h;
    uint count = 0;
    KEYS_OF_FOUR(planes, r, tmax, 0, a, b, c, d, count)
    KEYS_OF_FOUR(planes, r, tmax, 4, e, f, g, h, count)

    // Batcher's odd-even merge sort of eight keys: 19 comparisons
    IN_ORDER(a, b) IN_ORDER(c, d) IN_ORDER(e, f) IN_ORDER(g, h)
    IN_ORDER(a, c) IN_ORDER(b, d) IN_ORDER(e, g) IN_ORDER(f, h)
    IN_ORDER(b, c) IN_ORDER(f, g)
    IN_ORDER(a, e) IN_ORDER(b, f) IN_ORDER(c, g) IN_ORDER(d, h)
    IN_ORDER(c, e) IN_ORDER(d, f)
    IN_ORDER(b, c) IN_ORDER(d, e) IN_ORDER(f, g)

    uint near_four = CHILD(a, 0) | CHILD(b, 1) | CHILD(c, 2) | CHILD(d, 3);
    uint far_four = CHILD(e, 4) | CHILD(f, 5) | CHILD(g, 6) | CHILD(h, 7);
    uint order = near_four | far_four;
    uint end = 1u << KEY_PLACE_BITS * count; // children that are not met have the greatest keys and stand behind it
    return (order & (end - 1)) | end;
}

static void prepare_rays(TreeRays *w, const Scene *scene, Ray ray, mask active) {
    v3 inverse = v3_of(safe_inverse(ray.d.x), safe_inverse(ray.d.y), safe_inverse(ray.d.z));
    v3 widened = v3_scale(inverse, BOX_WIDENING);
    Shear s = shear_with(ray.d, inverse);
    uint kz = s.x ? 0 : s.y ? 1 : 2, kx = s.x ? 1 : s.y ? 2 : 0;
    uint near_x = inverse.x < 0 ? UPPER_PLANES(0) : LOWER_PLANES(0);
    uint near_y = inverse.y < 0 ? UPPER_PLANES(1) : LOWER_PLANES(1);
    uint near_z = inverse.z < 0 ? UPPER_PLANES(2) : LOWER_PLANES(2);
    LaneRay r = {
        {ray.o.x, ray.o.y, ray.o.z}, {inverse.x, inverse.y, inverse.z}, {widened.x, widened.y, widened.z},
        {near_x, near_y, near_z},
        {OPPOSITE_PLANES(0, near_x), OPPOSITE_PLANES(1, near_y), OPPOSITE_PLANES(2, near_z)}, kx, 3 - kx - kz, kz,
        {s.x ? ray.o.y : s.y ? ray.o.z : ray.o.x, s.x ? ray.o.z : s.y ? ray.o.x : ray.o.y,
         s.x ? ray.o.x : s.y ? ray.o.y : ray.o.z},
        s.shear_x, s.shear_y, s.scale_z, ray.tmin, ray.tmax};
    w->ray = r;
    w->order = children_in_order(scene->nodes, &r, ray.tmax);
    bool finite = !isnan(s.shear_x + s.shear_y + ray.o.x + ray.o.y + ray.o.z); // a NaN would meet every box
    w->walking = active && finite && w->order != NO_CHILDREN;
}

// Does the ray hit a primitive of the leaf before its tmax? The nearest one is kept in `hits`, unless `any` hit will
// do.
static bool hit_leaf(const Scene *scene, LaneRay *r, uint child, bool any, LaneHits *hits) {
    add_count(scene, COUNTER_blocks, 1);
    Leaf leaf = leaf_of(scene, child);
    real1 tmax = r->tmax; // the same bound for all eight, as in many_lanes/
    bool hit = false;
#pragma unroll 1
    for (uint i = 0; i < OPAL_WIDTH && leaf_has(leaf, i); i++) {
        BlockTest test = intersect_leaf(leaf, i, r);
        if (!test.inside || !(test.distance > r->tmin * test.determinant)) continue;
        if (!(test.distance < tmax * test.determinant)) continue;
        if (any) return true;
        real1 reciprocal = 1 / test.determinant, t = test.distance * reciprocal;
        if (!(t < r->tmax)) continue;
        hit = true;
        hits->t[0] = r->tmax = t;
        hits->u[0] = test.b * reciprocal;
        hits->v[0] = test.c * reciprocal;
        set_primitive(hits, 0, child, i);
    }
    return hit;
}

// Walks to the nearest hit, which it stores in `hits`, or to `any` hit. Returns whether there is one.
static bool walk(const Scene *scene, const TreeRays *w, bool any, LaneHits *hits) {
    LaneRay r = w->ray;
    uint node_above[OPAL_LEVELS], order_above[OPAL_LEVELS]; // a stack of nodes with unvisited children, and these
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
            child = scene->nodes[node].child[order & KEY_PLACE];
            order >>= KEY_PLACE_BITS;
            if (child & OPAL_LEAF) break;
            if (order != NO_CHILDREN) {
                node_above[top] = node;
                order_above[top] = order;
                top++;
            }
            add_count(scene, COUNTER_nodes, 1);
            node = child;
            order = children_in_order(scene->nodes + node, &r, r.tmax);
        }
        hit = hit_leaf(scene, &r, child, any, hits) || hit;
        if (any && hit) return true;
    }
}

static void walk_closest(const Scene *scene, const TreeRays *w, LaneHits *hits) { walk(scene, w, false, hits); }

static uint walk_any(const Scene *scene, const TreeRays *w) {
    LaneHits hits; // stays unset
    return walk(scene, w, true, &hits);
}
