// triangle: the triangles of meshes, flat or with interpolated normals.
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rows.cl"
#include "scene.cl"
#include "shapes/interface.cl"
#include "shapes/list.h"
#include "shared/types.h"
#include "surface.cl"
#if LANES == 1
#include "shapes/one_lane/triangle.cl"
#else
#include "shapes/many_lanes/triangle.cl"
#endif

// Corner `corner` of the triangles in `place` (Hit).
static v3 triangle_vertex(const Scene *scene, uints place, uint corner) {
    // A pointer to floats: beyond the first block the words lie past the row, where no array may be indexed.
    global const float *first = scene->triangle_blocks->vertex[corner][0];
    uints word = WORD_OF_PLACE(TriangleBlock, place);
    return v3_of(GATHER_WORD(real, first, word), GATHER_WORD(real, (first + OPAL_WIDTH), word),
                 GATHER_WORD(real, (first + 2 * OPAL_WIDTH), word));
}

// Index of the triangles in `place`.
static uints triangle_id(const Scene *scene, uints place) {
    global const uint *first = scene->triangle_blocks->id;
    return GATHER_WORD(uints, first, WORD_OF_PLACE(TriangleBlock, place));
}

static v3 vertex_normal(const Scene *scene, uints index) {
    uints word = index * 3u;
    return v3_of(GATHER_WORD(real, scene->normals, word), GATHER_WORD(real, (scene->normals + 1), word),
                 GATHER_WORD(real, (scene->normals + 2), word));
}

// The corner normals of triangles, as indices; `smooth`: the lanes where all three corners have one.
typedef struct { uints index[3]; mask smooth; } CornerNormals;

static CornerNormals corner_normals(const Scene *scene, uints triangle) {
    CornerNormals c = {{(uints)(0), (uints)(0), (uints)(0)}, NO_LANES};
    if (!OPAL_HAS_shading_normals) return c;
    uints n0 = GATHER(uints, scene->triangles, triangle, .normal[0]);
    uints n1 = GATHER(uints, scene->triangles, triangle, .normal[1]);
    uints n2 = GATHER(uints, scene->triangles, triangle, .normal[2]);
    c.smooth = to_mask(n0 != OPAL_NONE) & to_mask(n1 != OPAL_NONE) & to_mask(n2 != OPAL_NONE);
    c.index[0] = uints_pick(c.smooth, n0, (uints)(0));
    c.index[1] = uints_pick(c.smooth, n1, (uints)(0));
    c.index[2] = uints_pick(c.smooth, n2, (uints)(0));
    return c;
}

// The shading normal at barycentric weights u, v: interpolated where all corners have normals, else the geometric one.
static v3 shading_normal(const Scene *scene, CornerNormals corners, real u, real v, v3 geometric) {
    if (!OPAL_HAS_shading_normals || !ANY(corners.smooth)) return geometric;
    v3 n0 = vertex_normal(scene, corners.index[0]);
    v3 n = v3_mad(vertex_normal(scene, corners.index[1]), u,
                  v3_mad(vertex_normal(scene, corners.index[2]), v, v3_scale(n0, 1 - u - v)));
    real length2 = v3_dot(n, n);
    return v3_pick(corners.smooth & (length2 > 0), v3_scale(n, rsqrt(length2)), geometric);
}

// The texture coordinates of triangles' corners.
typedef struct { real u[3], v[3]; } CornerUvs;

static CornerUvs corner_uvs(const Scene *scene, uints triangle) {
    global const uint *first = (global const uint *)scene->triangle_uvs;
    uints word = triangle * (uint)(sizeof(TriangleUv) / 4);
    FourWords row = four_words(first, word), last = four_words(first, word + 2u);
    CornerUvs c = {{reals_of_words(row.a), reals_of_words(row.c), reals_of_words(last.c)},
                   {reals_of_words(row.b), reals_of_words(row.d), reals_of_words(last.d)}};
    return c;
}

// Those at barycentric weights b1, b2.
static v2 triangle_uv(CornerUvs c, real b1, real b2) {
    real b0 = 1 - b1 - b2;
    return v2_of(b0 * c.u[0] + b1 * c.u[1] + b2 * c.u[2], b0 * c.v[0] + b1 * c.v[1] + b2 * c.v[2]);
}

// Sets dpdu and dpdv of triangles with edges e1, e2. Where the texture coordinates span no area they are two unit
// vectors across the normal, those of Mitsuba.
static void set_triangle_tangents(CornerUvs c, v3 e1, v3 e2, Surface *s) {
    real du1 = c.u[1] - c.u[0], dv1 = c.v[1] - c.v[0], du2 = c.u[2] - c.u[0], dv2 = c.v[2] - c.v[0];
    real inverse = 1 / (du1 * dv2 - dv1 * du2);
    v3 dpdu = v3_scale(v3_mad(e1, dv2, v3_scale(e2, -dv1)), inverse);
    v3 dpdv = v3_scale(v3_mad(e2, du1, v3_scale(e1, -du2)), inverse);
    mask valid = is_finite(dpdu) & is_finite(dpdv);
    Frame any = frame_with_jump(s->normal, (real)(0));
    s->dpdu = v3_pick(valid, dpdu, any.s);
    s->dpdv = v3_pick(valid, dpdv, any.t);
}

// Barycentric weights that keep points away from the sides stay below a third, the weight of the centroid.
#define LARGEST_INSET R(0.3333)

static Surface surface_of_triangle(const Scene *scene, Ray ray, Hit hit, mask active) {
    uints place = uints_pick(active, hit.place, (uints)(0));
    // Indices come first: what they lead to is fetched while the rest is computed.
    uints triangle = triangle_id(scene, place), mesh = GATHER(uints, scene->triangles, triangle, .mesh);
    CornerNormals corners = corner_normals(scene, triangle);
    v3 p0 = triangle_vertex(scene, place, 0), p1 = triangle_vertex(scene, place, 1);
    v3 p2 = triangle_vertex(scene, place, 2);
    v3 e1 = v3_sub(p1, p0), e2 = v3_sub(p2, p0);
    v3 n = v3_cross(e1, e2);
    real length2 = v3_dot(n, n), inverse_length = rsqrt(length2);

    Surface s;
    s.normal = v3_scale(n, inverse_length);
    s.primitive = triangle;
    s.ray_offset = ray_offset_of(p0, p1, p2);
    s.t = hit.t;
    s.u = hit.u;
    s.v = hit.v;
    if (OPAL_HAS_face_list) {
        // A face-list hit is where the ray meets the plane. Edge-on that may be beyond the triangle's sides, or
        // nowhere: the nearest point of the triangle is taken.
        mask from_list = to_mask(hit.place >= scene->settings->face_list_slot);
        v3 from = v3_sub(ray.o, p0);
        v3 w = v3_mad(ray.d, -v3_dot(s.normal, from) / v3_dot(s.normal, ray.d), from);
        real u = real_min(real_max(v3_dot(v3_cross(w, e2), s.normal) * inverse_length, (real)(0)), (real)(1));
        real v = real_min(real_max(v3_dot(v3_cross(e1, w), s.normal) * inverse_length, (real)(0)), 1 - u);
        v3 along = v3_mad(e1, u, v3_mad(e2, v, v3_scale(from, (real)(-1))));
        s.t = from_list ? v3_dot(along, ray.d) / v3_dot(ray.d, ray.d) : s.t;
        s.u = from_list ? u : s.u;
        s.v = from_list ? v : s.v;
    }
    // The position is computed on the triangle, which is far closer to its plane than o + t d. It is kept two ray
    // offsets away from the sides where the triangle is wide enough, because a ray that starts on an edge of a closed
    // room could start outside of it. As a barycentric weight this is 2 offset / height, the height |n| / longest side,
    // and the longest side at most sqrt(2 (e1^2 + e2^2)).
    real two_longest = sqrt(8 * (v3_dot(e1, e1) + v3_dot(e2, e2)));
    real inset = real_min(s.ray_offset * two_longest * inverse_length, (real)(LARGEST_INSET));
    real u = real_min(real_max(s.u, inset), 1 - 2 * inset);
    real v = real_min(real_max(s.v, inset), 1 - inset - u);
    s.p = v3_mad(e1, u, v3_mad(e2, v, p0));
    s.uv = v2_of((real)(0), (real)(0));
    if (OPAL_HAS_uv) {
        CornerUvs uvs = corner_uvs(scene, triangle);
        s.uv = triangle_uv(uvs, s.u, s.v);
        if (OPAL_HAS_tangents) set_triangle_tangents(uvs, e1, e2, &s);
    }
    finish_surface(scene, ray, shading_normal(scene, corners, s.u, s.v, s.normal), mesh, &s);
    return s;
}
