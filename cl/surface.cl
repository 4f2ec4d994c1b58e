// surface: what is known of the points where rays met triangles.
typedef struct {
    v3 p;                // position
    real t, u, v;        // its distance along the ray, barycentric weights of corners 1 and 2
    v3 normal;           // geometric, unit, on the side of (p1-p0) x (p2-p0)
    Frame frame;         // around the shading normal
    v3 wi;               // towards where the ray came from, local
    uints triangle;      // its index
    real margin;         // bound of the error of p along the normal, with that of the next intersection
    uints bsdf, emitter; // indices; emitter = OPAL_NONE where it does not emit
} Surface;

// Corner `corner` of the triangles in `slot`.
static v3 triangle_vertex(const Scene *scene, uints slot, uint corner) {
    global const float *first = scene->blocks->vertex[corner][0];
    uints word = (slot >> 3) * (uint)(sizeof(TriangleBlock) / 4) + (slot & 7u);
    return v3_of(GATHER(real, first, word, ), GATHER(real, (first + 8), word, ), GATHER(real, (first + 16), word, ));
}

// Index of the triangles in `slot`.
static uints triangle_id(const Scene *scene, uints slot) {
    global const uint *first = scene->blocks->id;
    uints word = (slot >> 3) * (uint)(sizeof(TriangleBlock) / 4) + (slot & 7u);
    return GATHER(uints, first, word, );
}

static v3 vertex_normal(const Scene *scene, uints index) {
    uints word = index * 3u;
    return v3_of(GATHER(real, scene->normals, word, ), GATHER(real, (scene->normals + 1), word, ), GATHER(real, (scene->normals + 2), word, ));
}

// The corner normals of triangles, as indices; `smooth`: where all three corners have one.
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

// The shading normal at barycentric weights u, v: interpolated where the corners have normals, else the geometric.
static v3 shading_normal(const Scene *scene, CornerNormals corners, real u, real v, v3 geometric) {
    if (!OPAL_HAS_shading_normals || !ANY(corners.smooth)) return geometric;
    v3 n = v3_mad(vertex_normal(scene, corners.index[1]), u,
                  v3_mad(vertex_normal(scene, corners.index[2]), v, v3_scale(vertex_normal(scene, corners.index[0]), 1 - u - v)));
    real length2 = v3_dot(n, n);
    return v3_pick(corners.smooth & (length2 > 0), v3_scale(n, rsqrt(length2)), geometric);
}

// A bound of how far, along the normal, a point computed on this triangle may lie from it, and how far above it a ray must
// start to be seen on the right side by triangle.cl: both are some roundings of the largest coordinate involved.
static real surface_margin(v3 p0, v3 p1, v3 p2) {
    real largest = real_max(v3_largest(v3_abs(p0)), real_max(v3_largest(v3_abs(p1)), v3_largest(v3_abs(p2))));
    // Roundings of floats in either precision, for the scene's numbers are floats: the two triangles of a parallelogram do not lie in
    // one plane but for them, and in double half of a lamp would hide behind the other half.
    return 24 * R(5.9604645e-08) * largest;
}

// `found`: the lanes that hit something; the others get the values of slot 0. ray.d is unit but for rounding, which would add up in
// glass and mirrors: one Newton step towards 1 / sqrt(d.d) takes it away from wi.
static Surface surface_at(const Scene *scene, Ray ray, Hit hit, mask found) {
    uints slot = uints_pick(found, hit.slot, (uints)(0));
    // Indices first: what they lead to is fetched while the rest is computed.
    uints triangle = triangle_id(scene, slot), mesh = GATHER(uints, scene->triangles, triangle, .mesh);
    CornerNormals corners = corner_normals(scene, triangle);
    v3 p0 = triangle_vertex(scene, slot, 0), p1 = triangle_vertex(scene, slot, 1), p2 = triangle_vertex(scene, slot, 2);
    v3 e1 = v3_sub(p1, p0), e2 = v3_sub(p2, p0);
    v3 n = v3_cross(e1, e2);
    real length2 = v3_dot(n, n), inverse_length = rsqrt(length2);

    Surface s;
    s.normal = v3_scale(n, inverse_length);
    s.triangle = triangle;
    s.margin = surface_margin(p0, p1, p2);
    s.t = hit.t;
    s.u = hit.u;
    s.v = hit.v;
    if (OPAL_HAS_listed) {
        // Where the ray meets the plane; edge-on that may lie beyond the triangle's sides, or nowhere, and the nearest in it is taken.
        mask listed = to_mask(hit.slot >= scene->settings->listed_slot);
        v3 from = v3_sub(ray.o, p0);
        v3 w = v3_mad(ray.d, -v3_dot(s.normal, from) / v3_dot(s.normal, ray.d), from);
        real u = real_min(real_max(v3_dot(v3_cross(w, e2), s.normal) * inverse_length, (real)(0)), (real)(1));
        real v = real_min(real_max(v3_dot(v3_cross(e1, w), s.normal) * inverse_length, (real)(0)), 1 - u);
        s.t = listed ? v3_dot(v3_mad(e1, u, v3_mad(e2, v, v3_scale(from, (real)(-1)))), ray.d) / v3_dot(ray.d, ray.d) : s.t;
        s.u = listed ? u : s.u;
        s.v = listed ? v : s.v;
    }
    // From the triangle, not along the ray: far closer to the plane. And two margins away from its sides, as far as it is wide: a ray that
    // starts at an edge of a closed room could start outside of it. The longest side is at most sqrt(2 (e1^2 + e2^2)).
    real least = real_min(s.margin * sqrt(8 * (v3_dot(e1, e1) + v3_dot(e2, e2))) * inverse_length, (real)(R(0.3333)));
    real u = real_min(real_max(s.u, least), 1 - 2 * least);
    real v = real_min(real_max(s.v, least), 1 - least - u);
    s.p = v3_mad(e1, u, v3_mad(e2, v, p0));
    s.frame = frame_of(shading_normal(scene, corners, s.u, s.v, s.normal));
    s.wi = to_local(s.frame, v3_scale(ray.d, R(-1.5) + R(0.5) * v3_dot(ray.d, ray.d)));
    s.bsdf = GATHER(uints, scene->meshes, mesh, .bsdf);
    s.emitter = GATHER(uints, scene->meshes, mesh, .emitter);
    return s;
}

// A ray from the surface in direction d, started far enough above it not to meet it again.
static v3 leave_surface(Surface s, v3 d) {
    real side = copysign(s.margin, v3_dot(s.normal, d));
    return v3_mad(s.normal, side, s.p);
}
