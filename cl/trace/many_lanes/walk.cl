// many_lanes/walk: closest and any hit in the tree, for kernels that carry several lanes, as CPUs run them.
//
// The root's children are tested against all lanes at once. A lane that meets some of them walks on alone, with the
// eight children of a node or primitives of a leaf in one vector. Two lanes are walked in turn: while one waits for
// memory or for the end of a comparison, the other goes on.
#include "core/lanes.cl"
#include "core/many_lanes/eight_wide.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "shapes/interface.cl"
#include "shapes/list.h"
#include "shared/counters.h"
#include "shared/types.h"
#include "trace/rays.cl"

// All lanes' rays, one member of LaneRay an array, so that a loop can read one lane after the other.
typedef struct {
    real1 o[3][LANES], inverse[3][LANES], widened[3][LANES];
    real1 shear_x[LANES], shear_y[LANES], scale_z[LANES], tmin[LANES], tmax[LANES];
    int near[3][LANES], far[3][LANES], kx[LANES], ky[LANES], kz[LANES];
    key1 keys[OPAL_WIDTH][LANES], nearest[LANES]; // of the root's children; the least of them
    uint walking;                                 // the lanes that meet any of them, a bit each
} TreeRays;

// Tests the root's children against all lanes, as intersect_children does for one.
static void meet_root(TreeRays *rays, global const BvhNode *root, Ray ray, v3 inverse, mask active) {
    lane_keys none = NO_KEY, nearest = none;
    for (int i = 0; i < OPAL_WIDTH; i++) {
        if (root->child[i] == OPAL_NONE) {
            STORE(none, rays->keys[i]);
            continue;
        }
        v3 lo = v3_of((real)(root->lo[0][i]), (real)(root->lo[1][i]), (real)(root->lo[2][i]));
        v3 hi = v3_of((real)(root->hi[0][i]), (real)(root->hi[1][i]), (real)(root->hi[2][i]));
        v3 a = v3_mul(v3_sub(lo, ray.o), inverse), b = v3_mul(v3_sub(hi, ray.o), inverse);
        real enter = real_max(real_max(real_min(a.x, b.x), real_min(a.y, b.y)), real_max(real_min(a.z, b.z), ray.tmin));
        real leave = real_min(real_min(real_max(a.x, b.x), real_max(a.y, b.y)), real_max(a.z, b.z)) * BOX_WIDENING;
        mask meets = active & (enter <= real_min(leave, ray.tmax));
        lane_keys key = meets ? (real_bits(enter) & ~KEY_PLACE) | i : none;
        nearest = min(nearest, key);
        STORE(key, rays->keys[i]);
    }
    STORE(nearest, rays->nearest);
    rays->walking = lanes_of(nearest < none);
}

// Lays out the active lanes' rays, unless none meets the tree.
static void prepare_rays(TreeRays *rays, const Scene *scene, Ray ray, mask active) {
    v3 inverse = v3_of(safe_inverse(ray.d.x), safe_inverse(ray.d.y), safe_inverse(ray.d.z));
    meet_root(rays, scene->nodes, ray, inverse, active);
    if (rays->walking == 0) return;
    Shear s = shear_with(ray.d, inverse);
    STORE(ray.o.x, rays->o[0]); STORE(ray.o.y, rays->o[1]); STORE(ray.o.z, rays->o[2]);
    STORE(inverse.x, rays->inverse[0]); STORE(inverse.y, rays->inverse[1]); STORE(inverse.z, rays->inverse[2]);
    STORE(s.shear_x, rays->shear_x); STORE(s.shear_y, rays->shear_y); STORE(s.scale_z, rays->scale_z);
    STORE(ray.tmin, rays->tmin); STORE(ray.tmax, rays->tmax);
    ints kz = to_ints(s.x) ? (ints)(0) : to_ints(s.y) ? (ints)(1) : (ints)(2);
    ints kx = to_ints(s.x) ? (ints)(1) : to_ints(s.y) ? (ints)(2) : (ints)(0);
    STORE(kx, rays->kx); STORE(3 - kx - kz, rays->ky); STORE(kz, rays->kz);
    ints near_x = to_ints(inverse.x < 0) ? (ints)(UPPER_PLANES(0)) : (ints)(LOWER_PLANES(0));
    ints near_y = to_ints(inverse.y < 0) ? (ints)(UPPER_PLANES(1)) : (ints)(LOWER_PLANES(1));
    ints near_z = to_ints(inverse.z < 0) ? (ints)(UPPER_PLANES(2)) : (ints)(LOWER_PLANES(2));
    STORE(near_x, rays->near[0]); STORE(OPPOSITE_PLANES(0, near_x), rays->far[0]);
    STORE(near_y, rays->near[1]); STORE(OPPOSITE_PLANES(1, near_y), rays->far[1]);
    STORE(near_z, rays->near[2]); STORE(OPPOSITE_PLANES(2, near_z), rays->far[2]);
    v3 widened = v3_scale(inverse, (real)(BOX_WIDENING));
    STORE(widened.x, rays->widened[0]); STORE(widened.y, rays->widened[1]); STORE(widened.z, rays->widened[2]);
}

// Reads one lane's ray. One expression: PoCL would keep a loop over the axes as a copy in memory.
static LaneRay load_ray(const TreeRays *rays, int lane, real1 tmax) {
    uint kx = (uint)rays->kx[lane], ky = (uint)rays->ky[lane], kz = (uint)rays->kz[lane];
    LaneRay r = {
        {rays->o[0][lane], rays->o[1][lane], rays->o[2][lane]},
        {rays->inverse[0][lane], rays->inverse[1][lane], rays->inverse[2][lane]},
        {rays->widened[0][lane], rays->widened[1][lane], rays->widened[2][lane]},
        {(uint)rays->near[0][lane], (uint)rays->near[1][lane], (uint)rays->near[2][lane]},
        {(uint)rays->far[0][lane], (uint)rays->far[1][lane], (uint)rays->far[2][lane]},
        kx, ky, kz, {rays->o[kx][lane], rays->o[ky][lane], rays->o[kz][lane]},
        rays->shear_x[lane], rays->shear_y[lane], rays->scale_z[lane], rays->tmin[lane], tmax};
    return r;
}

// The children whose boxes the ray meets, and where it enters each.
static mask8 intersect_children(global const BvhNode *node, const LaneRay *ray, real8 *entry) {
    global const float *planes = node->lo[0]; // and after it node->hi
    real8 near_x = (load8(planes + ray->near[0]) - ray->o[0]) * ray->inverse[0];
    real8 near_y = (load8(planes + ray->near[1]) - ray->o[1]) * ray->inverse[1];
    real8 near_z = (load8(planes + ray->near[2]) - ray->o[2]) * ray->inverse[2];
    real8 far_x = (load8(planes + ray->far[0]) - ray->o[0]) * ray->widened[0];
    real8 far_y = (load8(planes + ray->far[1]) - ray->o[1]) * ray->widened[1];
    real8 far_z = (load8(planes + ray->far[2]) - ray->o[2]) * ray->widened[2];
    *entry = real8_max(real8_max(near_x, near_y), real8_max(near_z, (real8)(ray->tmin)));
    return *entry <= real8_min(real8_min(far_x, far_y), real8_min(far_z, (real8)(ray->tmax)));
}

// Prefetches a waiting child: the five cache lines of a triangle block; a node is smaller.
static void fetch_child(const Scene *scene, uint child) {
    if (!OPAL_HAS_large_tree) return;
    global const char *at =
        child & OPAL_LEAF ? leaf_of(scene, child).block : (global const char *)(scene->nodes + child);
    for (uint line = 0; line < sizeof(TriangleBlock) / CACHE_LINE; line++) FETCH(at + line * CACHE_LINE);
}

// Traversal state of one lane.
typedef struct {
    real1 tmax;                            // far bound
    int lane, active;                      // active: 0 where no lane is left to walk
    global const uint *children;           // of the current node
    int top;                               // of the stack
    global const uint *above[OPAL_LEVELS]; // a stack of nodes with unvisited children: their children
} Walk;

// Goes on to the next lane that meets the root's children, if there is one.
static void take_lane(const Scene *scene, const TreeRays *rays, uint *waiting, Walk *w) {
    w->active = *waiting != 0;
    if (!w->active) return;
    w->lane = lowest_lane(*waiting);
    *waiting &= *waiting - 1;
    w->tmax = rays->tmax[w->lane];
    w->top = 0;
    w->children = scene->nodes->child;
}

static mask8 root_keys(const TreeRays *rays, int lane) {
    return (mask8)(rays->keys[0][lane], rays->keys[1][lane], rays->keys[2][lane], rays->keys[3][lane],
                   rays->keys[4][lane], rays->keys[5][lane], rays->keys[6][lane], rays->keys[7][lane]);
}

// Closest-hit traversal.
typedef struct {
    Walk at;
    mask8 keys, left[OPAL_LEVELS];   // keys of the unvisited children, NO_KEY for others: current node; the stack
    key1 nearest, next[OPAL_LEVELS]; // the least of them, likewise
    key1 limit;                      // key of tmax; children with larger keys are culled
} ClosestWalk;


static void start_closest(const Scene *scene, const TreeRays *rays, uint *waiting, ClosestWalk *w) {
    take_lane(scene, rays, waiting, &w->at);
    if (!w->at.active) return;
    w->keys = root_keys(rays, w->at.lane);
    w->nearest = rays->nearest[w->at.lane];
    w->limit = key_of(w->at.tmax) | KEY_PLACE;
}

// The primitives of a block that are hit between tmin and tmax, as bytes_of.
static ulong hits_of(BlockTest test, const LaneRay *ray) {
    // A miss gets the far bound as its distance, so that one comparison decides: clang lowers mixed masks lane by lane.
    real8 bound = ray->tmax * test.determinant;
    real8 distance = test.distance > ray->tmin * test.determinant ? test.distance : bound;
    return bytes_of((test.inside ? distance : bound) < bound);
}

// Tests a leaf's primitives and keeps the nearest hit.
static void test_leaf(const Scene *scene, const TreeRays *rays, uint child, ClosestWalk *w, LaneHits *hits) {
    add_count(scene, COUNTER_blocks, 1);
    LaneRay ray = load_ray(rays, w->at.lane, w->at.tmax);
    BlockTest test = intersect_leaf(leaf_of(scene, child), 0, &ray);
    ulong met = hits_of(test, &ray);
    if (!met) return;
    real1 t[OPAL_WIDTH], reciprocal[OPAL_WIDTH], b[OPAL_WIDTH], c[OPAL_WIDTH];
    real8 inverse = 1 / test.determinant;
    vstore8(test.distance * inverse, 0, t);
    vstore8(inverse, 0, reciprocal);
    vstore8(test.b, 0, b);
    vstore8(test.c, 0, c);
    for (; met; met &= met - 1) {
        uint i = first_of(met);
        if (t[i] < w->at.tmax) {
            hits->t[w->at.lane] = w->at.tmax = t[i];
            hits->u[w->at.lane] = b[i] * reciprocal[i];
            hits->v[w->at.lane] = c[i] * reciprocal[i];
            set_primitive(hits, w->at.lane, child, i);
            w->limit = key_of(t[i]) | KEY_PLACE;
        }
    }
}

// Visits the nearest unvisited child. Where the walk ends, goes on to the next lane.
static void step_closest(const Scene *scene, const TreeRays *rays, uint *waiting, ClosestWalk *w, LaneHits *hits) {
    int top = w->at.top;
    uint child = w->at.children[w->nearest & KEY_PLACE];

    // Push the other children
    mask8 left = w->keys == (mask8)(w->nearest) ? (mask8)(NO_KEY) : w->keys;
    key1 second = least_key(left);
    w->left[top] = left;
    w->next[top] = second;
    w->at.above[top] = w->at.children;
    uint other = w->at.children[second & KEY_PLACE];
    fetch_child(scene, second <= w->limit ? other : child);
    top += second <= w->limit;

    // Visit this one
    w->nearest = NO_KEY;
    if (child & OPAL_LEAF) {
        test_leaf(scene, rays, child, w, hits);
    } else {
        add_count(scene, COUNTER_nodes, 1);
        real8 enter;
        LaneRay ray = load_ray(rays, w->at.lane, w->at.tmax);
        mask8 met = intersect_children(scene->nodes + child, &ray, &enter);
        w->keys = met ? (keys_of(enter) & ~KEY_PLACE) | (mask8)(0, 1, 2, 3, 4, 5, 6, 7) : (mask8)(NO_KEY);
        w->nearest = least_key(w->keys);
        w->at.children = scene->nodes[child].child;
    }

    // Nothing below: pop up to a child that is not behind the hit
    if (w->nearest > w->limit) {
        do {
            if (top == 0) {
                start_closest(scene, rays, waiting, w);
                return;
            }
            w->nearest = w->next[--top];
        } while (w->nearest > w->limit);
        w->keys = w->left[top];
        w->at.children = w->at.above[top];
    }
    w->at.top = top;
}

// The nearest hits of the walking lanes before their tmax. Leaves `hits` as it is where there is none.
static void walk_closest(const Scene *scene, const TreeRays *rays, LaneHits *hits) {
    uint waiting = rays->walking;
    ClosestWalk a, b;
    start_closest(scene, rays, &waiting, &a);
    start_closest(scene, rays, &waiting, &b);
    while (a.at.active | b.at.active) {
        if (a.at.active) step_closest(scene, rays, &waiting, &a, hits);
        if (b.at.active) step_closest(scene, rays, &waiting, &b, hits);
    }
}

// Any-hit traversal.
typedef struct {
    Walk at;
    ulong met, left[OPAL_LEVELS]; // the unvisited children that are met, as bytes_of: current node; the stack
} AnyWalk;

static void start_any(const Scene *scene, const TreeRays *rays, uint *waiting, AnyWalk *w) {
    take_lane(scene, rays, waiting, &w->at);
    if (w->at.active) w->met = bytes_of(root_keys(rays, w->at.lane) != (mask8)(NO_KEY));
}

// Visits the first unvisited child. Where the walk ends, goes on to the next lane.
static void step_any(const Scene *scene, const TreeRays *rays, uint *waiting, AnyWalk *w, uint *blocked) {
    if (!w->met) {
        if (w->at.top == 0) {
            start_any(scene, rays, waiting, w);
            return;
        }
        w->at.top--;
        w->met = w->left[w->at.top];
        w->at.children = w->at.above[w->at.top];
    }
    uint child = w->at.children[first_of(w->met)];
    w->met &= w->met - 1;
    w->left[w->at.top] = w->met;
    w->at.above[w->at.top] = w->at.children;
    w->at.top += w->met != 0;
    LaneRay ray = load_ray(rays, w->at.lane, w->at.tmax);
    if (child & OPAL_LEAF) {
        add_count(scene, COUNTER_blocks, 1);
        w->met = 0;
        if (hits_of(intersect_leaf(leaf_of(scene, child), 0, &ray), &ray)) {
            *blocked |= 1u << w->at.lane;
            start_any(scene, rays, waiting, w);
        }
    } else {
        add_count(scene, COUNTER_nodes, 1);
        real8 enter;
        w->met = bytes_of(intersect_children(scene->nodes + child, &ray, &enter));
        w->at.children = scene->nodes[child].child;
    }
}

// The walking lanes that meet anything between their tmin and tmax, a bit each.
static uint walk_any(const Scene *scene, const TreeRays *rays) {
    uint blocked = 0;
    uint waiting = rays->walking;
    AnyWalk a, b;
    start_any(scene, rays, &waiting, &a);
    start_any(scene, rays, &waiting, &b);
    while (a.at.active | b.at.active) {
        if (a.at.active) step_any(scene, rays, &waiting, &a, &blocked);
        if (b.at.active) step_any(scene, rays, &waiting, &b, &blocked);
    }
    return blocked;
}
