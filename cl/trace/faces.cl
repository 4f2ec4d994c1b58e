// faces: the face list, whose faces are each tested against all lanes at once. It holds the largest faces of a scene,
// or all of a tiny one. Many faces share vertices: each vertex is moved and sheared once.
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shapes/edge.cl"
#include "shapes/list.h"
#include "shared/types.h"
#include "trace/rays.cl"

// The face list's vertices as all lanes see them, moved to the ray's origin and sheared.
typedef struct { real x[OPAL_FACE_LIST_VERTICES], y[OPAL_FACE_LIST_VERTICES]; } FaceView;

// Computes the first `count` vertices.
static void view_faces(const Scene *scene, Ray ray, uint count, FaceView *view) {
    Shear s = shear_of(ray.d);
    // x = v[kx] - shear_x v[kz] - (the same of o), with the axes of each lane as vectors; likewise y.
    real zero = 0, one = 1, sx = -s.shear_x, sy = -s.shear_y;
    v3 px = v3_of(s.x ? sx : s.y ? zero : one, s.x ? one : s.y ? sx : zero, s.x ? zero : s.y ? one : sx);
    v3 py = v3_of(s.x ? sy : s.y ? one : zero, s.x ? zero : s.y ? sy : one, s.x ? one : s.y ? zero : sy);
    real ox = v3_dot(px, ray.o), oy = v3_dot(py, ray.o);
    for (uint i = 0; i < count; i++) {
        global const float *vertex = scene->face_vertices + 3 * i;
        real1 x = vertex[0], y = vertex[1], z = vertex[2];
        if (OPAL_HAS_tree) { // bit for bit as intersect_triangle sees a vertex, or rays leak between tree and face list
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

// The intersection of a ray with a face.
typedef struct {
    real distance, determinant; // t = distance / determinant, with determinant >= 0
    mask inside;                // the line through the ray meets the face
    mask beyond;                // beyond B C: in the triangle D C B
} FaceTest;

// Inside or outside is decided by watertight edge tests. The distance comes from the face's plane, which is cheaper and
// exact enough to rank hits.
static FaceTest face_test(const FaceView *view, Ray ray, global const FaceRecord *face) {
    uint i = face->corner[0], j = face->corner[1], k = face->corner[2], l = face->corner[3];
    real ab = edge(view->x[i], view->y[i], view->x[j], view->y[j]);
    real bd = edge(view->x[j], view->y[j], view->x[l], view->y[l]);
    real dc = edge(view->x[l], view->y[l], view->x[k], view->y[k]);
    real ca = edge(view->x[k], view->y[k], view->x[i], view->y[i]);
    real bc = edge(view->x[j], view->y[j], view->x[k], view->y[k]);
    mask positive = real_min(real_min(ab, ca), real_min(bd, dc)) >= 0;
    mask negative = real_max(real_max(ab, ca), real_max(bd, dc)) <= 0;
    real1 x = face->normal[0], y = face->normal[1], z = face->normal[2];
    real height = mul_add((real)(-y), ray.o.y, mul_add((real)(-z), ray.o.z, (real)(face->along)));
    real distance = mul_add((real)(-x), ray.o.x, height);
    real determinant = mul_add((real)(x), ray.d.x, mul_add((real)(y), ray.d.y, (real)(z) * ray.d.z));
    mask beyond = positive ? bc < 0 : bc > 0;
    FaceTest test = {turned_as(distance, determinant), fabs(determinant), positive | negative, beyond};
    return test;
}

// The nearest face so far, with distance and determinant as in FaceTest. triangle: 2 i, or 2 i + 1 for D C B of face i;
// OPAL_NONE: none yet
typedef struct { real distance, determinant; uints triangle; } NearestFace;

// Takes a candidate where it is nearer. Products are compared, which saves a division a face.
static void prefer(NearestFace *best, mask candidate, real distance, real determinant, uints triangle) {
    mask nearer = candidate & (distance * best->determinant < best->distance * determinant);
    best->distance = nearer ? distance : best->distance;
    best->determinant = nearer ? determinant : best->determinant;
    best->triangle = uints_pick(nearer, triangle, best->triangle);
}

static void try_face(const Scene *scene, const FaceView *view, Ray ray, uint i, NearestFace *best) {
    FaceTest test = face_test(view, ray, scene->faces + i);
    prefer(best, test.inside & (test.distance > ray.tmin * test.determinant), test.distance, test.determinant,
           uints_pick(test.beyond, (uints)(2 * i + 1), (uints)(2 * i)));
}

// The nearest hit of the face list. Two independent minima hide the latency of compare-and-select.
static Hit faces_closest(const Scene *scene, Ray ray) {
    FaceView view;
    view_faces(scene, ray, scene->settings->face_list.vertices, &view);
    NearestFace best = {ray.tmax, (real)(1), (uints)(OPAL_NONE)}, other = best;
    uint faces = scene->settings->face_list.faces, i = 0;
    for (; i + 1 < faces; i += 2) {
        try_face(scene, &view, ray, i, &best);
        try_face(scene, &view, ray, i + 1, &other);
    }
    if (i < faces) try_face(scene, &view, ray, i, &best);
    prefer(&best, ALL_LANES, other.distance, other.determinant, other.triangle);
    mask found = to_mask(best.triangle != OPAL_NONE);
    Hit hit = {best.distance / best.determinant, (real)(0), (real)(0), (uints)(SHAPE_triangle),
               uints_pick(found, scene->settings->face_list_slot + best.triangle, (uints)(OPAL_NONE))};
    return hit;
}

// The active lanes whose ray meets a face between tmin and tmax. among: the first faces of the list to test
static mask faces_any(const Scene *scene, Ray ray, FaceRange among, mask active) {
    FaceView view;
    view_faces(scene, ray, among.vertices, &view);
    mask blocked = !active;
    for (uint i = 0; i < among.faces; i++) {
        FaceTest test = face_test(&view, ray, scene->faces + i);
        mask after_tmin = test.distance > ray.tmin * test.determinant;
        blocked = blocked | (test.inside & after_tmin & (test.distance < ray.tmax * test.determinant));
    }
    return blocked & active;
}
