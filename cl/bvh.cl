// bvh: closest and any hit of each lane. The largest faces of a scene, or all of a tiny one, are listed: each is tested against
// all lanes at once. The other triangles are in a tree. Its root's children are tested against all lanes at once, too; a lane that
// meets some walks on alone, with the eight children or triangles of a node in one vector. Two lanes are walked in turn: while one waits
// for memory or for a comparison's end, the other goes on.

// The axis of the largest component of d, and with it the shear of triangle.cl.
typedef struct {
    mask x, y;                      // kz = 0, kz = 1; else 2
    real shear_x, shear_y, scale_z; // d[kx] / d[kz], d[ky] / d[kz], 1 / d[kz], with kx = kz + 1, ky = kz + 2 mod 3
} Shear;

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

// Without 1 / d at hand: only the largest component's is asked for.
static Shear shear_of(v3 d) {
    Shear s = shear_with(d, d);
    return shear_with(d, v3_all(1 / s.scale_z));
}

// 1/d, finite also for zeros, whose sign is kept: a box test then never meets 0 * inf.
static real safe_inverse(real d) { return 1 / (fabs(d) < R(1e-30) ? copysign((real)(R(1e-30)), d) : d); }

// A key says which child of its node a ray meets, and orders children by where it enters them: that distance's bits, which compare
// as the (positive) distance does, with the child's place in the last three.
#define KEYS_PLACE 7

static key1 least(mask8 keys) {
    half_keys four = min(keys.lo, keys.hi);
    quarter_keys two = min(four.lo, four.hi);
    return min(two.x, two.y);
}

// All lanes' rays, laid out so that a loop can read one lane after the other.
typedef struct {
    real1 o[3][LANES], inverse[3][LANES], widened[3][LANES], shear_x[LANES], shear_y[LANES], scale_z[LANES], tmin[LANES], tmax[LANES];
    int near[3][LANES], far[3][LANES], kx[LANES], ky[LANES], kz[LANES]; // as in LaneRay
    key1 keys[8][LANES], nearest[LANES]; // of the root's children; the least of them
    uint walking;                        // the lanes that meet any, a bit each
} LaneRays;

// Tests the root's children against all lanes as intersect_children does for one.
static void meet_root(LaneRays *rays, global const BvhNode *root, Ray ray, v3 inverse, mask live) {
    lane_keys none = NO_KEY, nearest = none;
    for (int i = 0; i < 8; i++) {
        if (root->child[i] == OPAL_NONE) {
            STORE(none, rays->keys[i]);
            continue;
        }
        v3 lo = v3_of((real)(root->lo[0][i]), (real)(root->lo[1][i]), (real)(root->lo[2][i]));
        v3 hi = v3_of((real)(root->hi[0][i]), (real)(root->hi[1][i]), (real)(root->hi[2][i]));
        v3 a = v3_mul(v3_sub(lo, ray.o), inverse), b = v3_mul(v3_sub(hi, ray.o), inverse);
        real enter = real_max(real_max(real_min(a.x, b.x), real_min(a.y, b.y)), real_max(real_min(a.z, b.z), ray.tmin));
        real leave = real_min(real_min(real_max(a.x, b.x), real_max(a.y, b.y)), real_max(a.z, b.z)) * (1 + 8 * EPSILON);
        mask meets = live & (enter <= real_min(leave, ray.tmax));
        lane_keys key = meets ? (real_bits(enter) & ~KEYS_PLACE) | i : none;
        nearest = min(nearest, key);
        STORE(key, rays->keys[i]);
    }
    STORE(nearest, rays->nearest);
    rays->walking = lanes_of(nearest < none);
}

static void store_rays(LaneRays *rays, const Scene *scene, Ray ray, mask live) {
    v3 inverse = v3_of(safe_inverse(ray.d.x), safe_inverse(ray.d.y), safe_inverse(ray.d.z));
    meet_root(rays, scene->nodes, ray, inverse, live);
    if (rays->walking == 0) return;
    Shear s = shear_with(ray.d, inverse);
    STORE(ray.o.x, rays->o[0]); STORE(ray.o.y, rays->o[1]); STORE(ray.o.z, rays->o[2]);
    STORE(inverse.x, rays->inverse[0]); STORE(inverse.y, rays->inverse[1]); STORE(inverse.z, rays->inverse[2]);
    STORE(s.shear_x, rays->shear_x); STORE(s.shear_y, rays->shear_y); STORE(s.scale_z, rays->scale_z);
    STORE(ray.tmin, rays->tmin); STORE(ray.tmax, rays->tmax);
    ints kz = to_ints(s.x) ? (ints)(0) : to_ints(s.y) ? (ints)(1) : (ints)(2);
    ints kx = to_ints(s.x) ? (ints)(1) : to_ints(s.y) ? (ints)(2) : (ints)(0);
    STORE(kx, rays->kx); STORE(3 - kx - kz, rays->ky); STORE(kz, rays->kz);
    ints lower = (ints)(0), upper = (ints)(24); // rows of BvhNode::lo and BvhNode::hi
    ints near_x = to_ints(inverse.x < 0) ? upper : lower, near_y = to_ints(inverse.y < 0) ? upper + 8 : lower + 8;
    ints near_z = to_ints(inverse.z < 0) ? upper + 16 : lower + 16;
    STORE(near_x, rays->near[0]); STORE(near_y, rays->near[1]); STORE(near_z, rays->near[2]);
    STORE(24 - near_x, rays->far[0]); STORE(40 - near_y, rays->far[1]); STORE(56 - near_z, rays->far[2]);
    v3 widened = v3_scale(inverse, (real)(1 + 8 * EPSILON));
    STORE(widened.x, rays->widened[0]); STORE(widened.y, rays->widened[1]); STORE(widened.z, rays->widened[2]);
}

// Of which only what a test needs is read: one expression, for a loop over the axes would be kept as a copy in memory.
static LaneRay load_ray(const LaneRays *rays, int lane, real1 tmax) {
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

// Which children's boxes the ray meets, and where it enters them. (plane - o) / d loses nothing that
// matters, and the far side is widened by its error bound, so that no box misses a triangle inside it (Ize 2013).
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

// Asks for the memory of a child that waits.
static void fetch_child(const Scene *scene, uint child) {
    if (!OPAL_HAS_large_tree) return;
    global const char *at = child & OPAL_LEAF ? (global const char *)(scene->blocks + (child & ~OPAL_LEAF))
                                              : (global const char *)(scene->nodes + child);
    FETCH(at); FETCH(at + 64); FETCH(at + 128); FETCH(at + 192); FETCH(at + 256);
}

// What walks share: the lane, its far bound, the children of the node that it is at, and those of the nodes above that have some left.
typedef struct {
    real1 tmax;
    int lane, alive, top;
    global const uint *children, *above[OPAL_LEVELS];
} Walk;

// On to the next lane that meets the root's children; `alive` says whether there is one.
static void take_lane(const Scene *scene, const LaneRays *rays, uint *waiting, Walk *w) {
    w->alive = *waiting != 0;
    if (!w->alive) return;
    w->lane = lowest_lane(*waiting);
    *waiting &= *waiting - 1;
    w->tmax = rays->tmax[w->lane];
    w->top = 0;
    w->children = scene->nodes->child;
}

static mask8 root_keys(const LaneRays *rays, int lane) {
    return (mask8)(rays->keys[0][lane], rays->keys[1][lane], rays->keys[2][lane], rays->keys[3][lane],
                   rays->keys[4][lane], rays->keys[5][lane], rays->keys[6][lane], rays->keys[7][lane]);
}

// A walk to the nearest hit: of each node the keys of its children, those taken set to NO_KEY, and the least of them. limit: the greatest key that
// what is entered before tmax may have.
typedef struct {
    Walk at;
    mask8 keys, left[OPAL_LEVELS];
    key1 nearest, next[OPAL_LEVELS], limit;
} ClosestWalk;

// The nearest hits of all lanes.
typedef struct {
    real1 t[LANES], u[LANES], v[LANES];
    uint slot[LANES];
} LaneHits;

static void start_closest(const Scene *scene, const LaneRays *rays, uint *waiting, ClosestWalk *w) {
    take_lane(scene, rays, waiting, &w->at);
    if (!w->at.alive) return;
    w->keys = root_keys(rays, w->at.lane);
    w->nearest = rays->nearest[w->at.lane];
    w->limit = key_of(w->at.tmax) | KEYS_PLACE;
}

static void test_block(const Scene *scene, const LaneRays *rays, uint block, ClosestWalk *w, LaneHits *hits) {
    COUNT_TESTS(scene, blocks, 1);
    LaneRay ray = load_ray(rays, w->at.lane, w->at.tmax);
    BlockTest test = intersect_block(scene->blocks + block, &ray);
    if (!test.hits) return;
    real1 t[8], reciprocal[8], b[8], c[8];
    real8 inverse = 1 / test.determinant;
    vstore8(test.distance * inverse, 0, t);
    vstore8(inverse, 0, reciprocal);
    vstore8(test.b, 0, b);
    vstore8(test.c, 0, c);
    for (; test.hits; test.hits &= test.hits - 1) {
        uint i = first_of(test.hits);
        if (t[i] < w->at.tmax) {
            hits->t[w->at.lane] = w->at.tmax = t[i];
            hits->u[w->at.lane] = b[i] * reciprocal[i];
            hits->v[w->at.lane] = c[i] * reciprocal[i];
            hits->slot[w->at.lane] = block * 8 + i;
            w->limit = key_of(t[i]) | KEYS_PLACE;
        }
    }
}

// To the nearest child that is left; where the walk ends, to the next lane.
static void step_closest(const Scene *scene, const LaneRays *rays, uint *waiting, ClosestWalk *w, LaneHits *hits) {
    int top = w->at.top;
    uint child = w->at.children[w->nearest & KEYS_PLACE];

    // The others wait
    mask8 left = w->keys == (mask8)(w->nearest) ? (mask8)(NO_KEY) : w->keys;
    key1 second = least(left);
    w->left[top] = left;
    w->next[top] = second;
    w->at.above[top] = w->at.children;
    uint other = w->at.children[second & KEYS_PLACE];
    fetch_child(scene, second <= w->limit ? other : child);
    top += second <= w->limit;

    // Down to this one
    w->nearest = NO_KEY;
    if (child & OPAL_LEAF) {
        test_block(scene, rays, child & ~OPAL_LEAF, w, hits);
    } else {
        COUNT_TESTS(scene, nodes, 1);
        real8 enter;
        LaneRay ray = load_ray(rays, w->at.lane, w->at.tmax);
        mask8 met = intersect_children(scene->nodes + child, &ray, &enter);
        w->keys = met ? (keys_of(enter) & ~KEYS_PLACE) | (mask8)(0, 1, 2, 3, 4, 5, 6, 7) : (mask8)(NO_KEY);
        w->nearest = least(w->keys);
        w->at.children = scene->nodes[child].child;
    }

    // Nothing there: back to what waits and is not behind the hit
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

// Nearest hits of the lanes that meet the root's children, before their tmax; leaves `hits` as it is where there is none.
static void walk_closest(const Scene *scene, const LaneRays *rays, LaneHits *hits) {
    uint waiting = rays->walking;
    ClosestWalk a, b;
    start_closest(scene, rays, &waiting, &a);
    b.at.alive = 0;
    if (LANES > 1) start_closest(scene, rays, &waiting, &b);
    while (a.at.alive | b.at.alive) {
        if (a.at.alive) step_closest(scene, rays, &waiting, &a, hits);
        if (b.at.alive) step_closest(scene, rays, &waiting, &b, hits);
    }
}

// A walk to any hit: the children that are met and not taken yet, a byte each.
typedef struct {
    Walk at;
    ulong met, left[OPAL_LEVELS];
} AnyWalk;

static void start_any(const Scene *scene, const LaneRays *rays, uint *waiting, AnyWalk *w) {
    take_lane(scene, rays, waiting, &w->at);
    if (w->at.alive) w->met = bytes_of(root_keys(rays, w->at.lane) != (mask8)(NO_KEY));
}

// To the first child that is left; where the walk ends, to the next lane.
static void step_any(const Scene *scene, const LaneRays *rays, uint *waiting, AnyWalk *w, uint *blocked) {
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
        COUNT_TESTS(scene, blocks, 1);
        w->met = 0;
        if (intersect_block(scene->blocks + (child & ~OPAL_LEAF), &ray).hits) {
            *blocked |= 1u << w->at.lane;
            start_any(scene, rays, waiting, w);
        }
    } else {
        COUNT_TESTS(scene, nodes, 1);
        real8 enter;
        w->met = bytes_of(intersect_children(scene->nodes + child, &ray, &enter));
        w->at.children = scene->nodes[child].child;
    }
}

// The lanes that meet the root's children and anything between their tmin and tmax.
static uint walk_any(const Scene *scene, const LaneRays *rays) {
    uint blocked = 0;
    uint waiting = rays->walking;
    AnyWalk a, b;
    start_any(scene, rays, &waiting, &a);
    b.at.alive = 0;
    if (LANES > 1) start_any(scene, rays, &waiting, &b);
    while (a.at.alive | b.at.alive) {
        if (a.at.alive) step_any(scene, rays, &waiting, &a, &blocked);
        if (b.at.alive) step_any(scene, rays, &waiting, &b, &blocked);
    }
    return blocked;
}

// Listed faces: the vertices as all lanes see them, moved and sheared once for all faces that share them.
typedef struct { real x[OPAL_LISTED_VERTICES], y[OPAL_LISTED_VERTICES]; } ListedView;

// The first `count` vertices.
static void view_listed(const Scene *scene, Ray ray, uint count, ListedView *view) {
    Shear s = shear_of(ray.d);
    // x = v[kx] - shear_x v[kz] - (the same of o), with the axes of each lane as vectors; likewise y.
    real zero = 0, one = 1;
    v3 px = v3_of(s.x ? -s.shear_x : s.y ? zero : one, s.x ? one : s.y ? -s.shear_x : zero, s.x ? zero : s.y ? one : -s.shear_x);
    v3 py = v3_of(s.x ? -s.shear_y : s.y ? one : zero, s.x ? zero : s.y ? -s.shear_y : one, s.x ? one : s.y ? zero : -s.shear_y);
    real ox = v3_dot(px, ray.o), oy = v3_dot(py, ray.o);
    for (uint i = 0; i < count; i++) {
        real1 x = scene->listed_vertices[3 * i], y = scene->listed_vertices[3 * i + 1], z = scene->listed_vertices[3 * i + 2];
        if (OPAL_HAS_tree) { // to the bit what intersect_block makes of a vertex, or rays leak between its triangles and these
            v3 d = v3_sub(v3_of((real)(x), (real)(y), (real)(z)), ray.o);
            real along = s.x ? d.x : s.y ? d.y : d.z;
            view->x[i] = mul_add(-s.shear_x, along, s.x ? d.y : s.y ? d.z : d.x);
            view->y[i] = mul_add(-s.shear_y, along, s.x ? d.z : s.y ? d.x : d.y);
        } else {
            view->x[i] = mul_add(px.x, (real)(x), mul_add(px.y, (real)(y), mul_add(px.z, (real)(z), -ox)));
            view->y[i] = mul_add(py.x, (real)(x), mul_add(py.y, (real)(y), mul_add(py.z, (real)(z), -oy)));
        }
    }
}

// A face in that view: whether the ray's line meets it, at t = distance / determinant with determinant >= 0, and on which side of B C.
typedef struct { real distance, determinant; mask inside, beyond; } FaceTest;

// Whether a face is met its corners decide, so that none is missed between two faces; where, its plane, which is less work and enough to tell
// which is the nearest.
static FaceTest face_test(const ListedView *view, Ray ray, global const ListedFace *face) {
    uint i = face->corner[0], j = face->corner[1], k = face->corner[2], l = face->corner[3];
    real ab = lanes_edge(view->x[i], view->y[i], view->x[j], view->y[j]);
    real bd = lanes_edge(view->x[j], view->y[j], view->x[l], view->y[l]);
    real dc = lanes_edge(view->x[l], view->y[l], view->x[k], view->y[k]);
    real ca = lanes_edge(view->x[k], view->y[k], view->x[i], view->y[i]);
    real bc = lanes_edge(view->x[j], view->y[j], view->x[k], view->y[k]);
    mask positive = real_min(real_min(ab, ca), real_min(bd, dc)) >= 0, negative = real_max(real_max(ab, ca), real_max(bd, dc)) <= 0;
    real1 x = face->normal[0], y = face->normal[1], z = face->normal[2];
    real distance = mul_add((real)(-x), ray.o.x, mul_add((real)(-y), ray.o.y, mul_add((real)(-z), ray.o.z, (real)(face->along))));
    real determinant = mul_add((real)(x), ray.d.x, mul_add((real)(y), ray.d.y, (real)(z) * ray.d.z));
    FaceTest test = {turned_as(distance, determinant), fabs(determinant), positive | negative, positive ? bc < 0 : bc > 0};
    return test;
}

// The nearest of the listed faces so far, as FaceTest has it. triangle: 2 i, or 2 i + 1 for D C B of face i
typedef struct { real distance, determinant; uints triangle; } NearestFace;

static void prefer(NearestFace *best, mask candidate, real distance, real determinant, uints triangle) {
    // By products, without a division a face.
    mask nearer = candidate & (distance * best->determinant < best->distance * determinant);
    best->distance = nearer ? distance : best->distance;
    best->determinant = nearer ? determinant : best->determinant;
    best->triangle = uints_pick(nearer, triangle, best->triangle);
}

static void try_face(const Scene *scene, const ListedView *view, Ray ray, uint i, NearestFace *best) {
    FaceTest test = face_test(view, ray, scene->listed_faces + i);
    prefer(best, test.inside & (test.distance > ray.tmin * test.determinant), test.distance, test.determinant,
           uints_pick(test.beyond, (uints)(2 * i + 1), (uints)(2 * i)));
}

// Two halves are searched side by side: one comparison waits for the one before.
static Hit listed_closest(const Scene *scene, Ray ray) {
    ListedView view;
    view_listed(scene, ray, scene->settings->listed.vertices, &view);
    NearestFace best = {ray.tmax, (real)(1), (uints)(OPAL_NONE)}, other = best;
    uint count = scene->settings->listed.faces, i = 0;
    for (; i + 1 < count; i += 2) {
        try_face(scene, &view, ray, i, &best);
        try_face(scene, &view, ray, i + 1, &other);
    }
    if (i < count) try_face(scene, &view, ray, i, &best);
    prefer(&best, ALL_LANES, other.distance, other.determinant, other.triangle);
    mask found = to_mask(best.triangle != OPAL_NONE);
    Hit hit = {best.distance / best.determinant, (real)(0), (real)(0),
               uints_pick(found, scene->settings->listed_slot + best.triangle, (uints)(OPAL_NONE))};
    return hit;
}

// `among`: which faces are asked, from the first on.
static mask listed_any(const Scene *scene, Ray ray, FaceRange among, mask live) {
    ListedView view;
    view_listed(scene, ray, among.vertices, &view);
    mask blocked = !live;
    for (uint i = 0; i < among.faces; i++) {
        FaceTest test = face_test(&view, ray, scene->listed_faces + i);
        blocked = blocked | (test.inside & (test.distance > ray.tmin * test.determinant) & (test.distance < ray.tmax * test.determinant));
    }
    return blocked & live;
}
#include "one_lane/walk.cl"
// The nearest hit of each live lane.
static Hit closest_hit(const Scene *scene, Ray ray, mask live) {
    Hit hit = {ray.tmax, (real)(0), (real)(0), (uints)(OPAL_NONE)};
    if (OPAL_HAS_listed) hit = listed_closest(scene, ray);
    if (!OPAL_HAS_tree) return hit;
    ray.tmax = hit.t;
    LaneRays rays;
    store_rays(&rays, scene, ray, live);
    if (rays.walking == 0) return hit;
    LaneHits hits;
    STORE(hit.t, hits.t); STORE(hit.u, hits.u); STORE(hit.v, hits.v); STORE(hit.slot, hits.slot);
    walk_closest(scene, &rays, &hits);
    Hit nearest = {LOAD(real, hits.t), LOAD(real, hits.u), LOAD(real, hits.v), LOAD(uints, hits.slot)};
    return nearest;
}

// The live lanes whose way is blocked between tmin and tmax, by the tree or by one of those listed faces.
static mask blocked_by(const Scene *scene, Ray ray, FaceRange among, mask live) {
    mask listed = NO_LANES;
    if (OPAL_HAS_listed && among.faces > 0) listed = listed_any(scene, ray, among, live);
    if (!OPAL_HAS_tree) return listed;
    LaneRays rays;
    store_rays(&rays, scene, ray, live & !listed);
    if (rays.walking == 0) return listed;
    return listed | mask_of(walk_any(scene, &rays));
}

static mask any_hit(const Scene *scene, Ray ray, mask live) { return blocked_by(scene, ray, scene->settings->listed, live); }

// The same for a ray from a point of the scene to one on a light: neither the walls around the scene nor the only lamp can block it.
static mask any_hit_to_light(const Scene *scene, Ray ray, mask live) { return blocked_by(scene, ray, scene->settings->listed_to_light, live); }
