// rays: traversal alone, on rays like those of a render (host/bench/rays.h).
//
// Rays and hits are planes of `stride` floats, a multiple of 16 (kernels/rays_list.h).
#include "lanes.cl"
#include "math.cl"
#include "rng.cl"
#include "warp.cl"
#include "scene.cl"
#include "triangle.cl"
#include "bvh.cl"
#include "surface.cl"
#include "emitter.cl"
#include "camera.cl"
#include "planes.cl"
#include "kernels/rays_list.h"

static Ray get_ray(global const float *rays, uint stride, uint base) {
    Ray ray = {get_v3(rays, TRACE_O_X, stride, base), get_v3(rays, TRACE_D_X, stride, base), get(rays, TRACE_TMIN, stride, base),
               get(rays, TRACE_TMAX, stride, base)};
    return ray;
}

static void put_ray(global float *rays, uint stride, uint base, Ray ray, mask there) {
    put_v3(rays, TRACE_O_X, stride, base, ray.o);
    put(rays, TRACE_TMIN, stride, base, ray.tmin);
    put_v3(rays, TRACE_D_X, stride, base, ray.d);
    put(rays, TRACE_TMAX, stride, base, there ? ray.tmax : (real)(-1));
}

// Camera rays, one a pixel, in tiles of 8 x 8; the film's sides are multiples of 8.
static Ray tiled_camera_ray(const Scene *scene, Sampler sampler, uints i) {
    uint columns = scene->settings->width / 8;
    uints tile = i >> 6, row = tile / columns;
    uints x = (tile - row * columns) * 8 + (i & 7u), y = row * 8 + ((i >> 3) & 7u);
    return camera_ray(scene, x, y, draw(scene, sampler, (uints)(DIM_FILM)));
}

// A cosine-distributed ray from the side that was seen.
static Ray bounce_ray(const Scene *scene, Sampler sampler, Surface s, v3 normal) {
    v3 d = to_world(frame_of(normal), square_to_cosine_hemisphere(draw(scene, sampler, (uints)(1 + DIM_BSDF))));
    Ray ray = {leave_surface(s, d), d, (real)(0), (real)(FAR)};
    return ray;
}

// A ray to a point on a light as cl/lighting.cl sends it, or, where there are none, to a point of the box lo + [0, 1]^3 size.
static Ray shadow_ray(const Scene *scene, Sampler sampler, Surface s, v3 normal, v3 lo, v3 size, mask *live) {
    v2 point = draw(scene, sampler, (uints)(1 + DIM_LIGHT));
    u2 choice = draw_bits(scene, sampler, (uints)(1 + DIM_EMITTER));
    v3 end = v3_add(lo, v3_mul(size, v3_of(point.x, point.y, unit_real(choice.x))));
    if (EMITTER_KINDS > 0) {
        uints id = emitter_choose(scene, choice);
        EmitterSample light = emitter_sample(scene, id, point, draw_bits(scene, sampler, (uints)(1 + DIM_TRIANGLE)), *live);
        v3 to_light = v3_sub(light.p, s.p);
        *live = *live & (light.discrete | (v3_dot(light.facing, to_light) < 0)) & (v3_dot(normal, to_light) > 0);
        end = v3_mad(light.normal, copysign(light.margin, -v3_dot(light.normal, to_light)), light.p);
    }
    v3 start = leave_surface(s, v3_sub(end, s.p));
    Ray ray = {start, v3_sub(end, start), (real)(0), (real)(1)};
    return ray;
}

// Writes rays base ... of one kind; tmax = -1: no such ray, because the camera's ray met nothing or the light turns away.
kernel void generate(SCENE_PARAMETERS, uint kind, float lo_x, float lo_y, float lo_z, float size_x, float size_y, float size_z,
                     global float *rays, uint first, uint stride) {
    uint base = first + (uint)get_global_id(0) * LANES;
    if (base >= stride) return;
    Scene scene = SCENE_OF_PARAMETERS;
    uint counts[TESTS_KINDS];
    scene.tests = counts;
    uints i = lane_indices(base);
    mask live = to_mask(i < settings->width * settings->height);
    Sampler sampler = sampler_start(i, (uints)(0), settings->seed);
    Ray ray = tiled_camera_ray(&scene, sampler, i);
    if (kind != RAYS_camera) {
        Hit hit = closest_hit(&scene, ray, live);
        live = live & to_mask(hit.slot != OPAL_NONE);
        Surface s = surface_at(&scene, ray, hit, live);
        v3 normal = v3_scale(s.normal, copysign((real)(1), -v3_dot(s.normal, ray.d)));
        if (kind == RAYS_bounce) ray = bounce_ray(&scene, sampler, s, normal);
        else ray = shadow_ray(&scene, sampler, s, normal, v3_of((real)(lo_x), (real)(lo_y), (real)(lo_z)),
                              v3_of((real)(size_x), (real)(size_y), (real)(size_z)), &live);
    }
    put_ray(rays, stride, base, ray, live);
}

// The rays of a work-item: rays_an_item from its own first one on, LANES at a time.
#define EACH_RAYS(body) \
    uint begin = (uint)get_global_id(0) * rays_an_item; \
    Scene scene = SCENE_OF_PARAMETERS; \
    uint counts[TESTS_KINDS] = {0}; \
    scene.tests = counts; \
    for (uint base = begin; base < min(begin + rays_an_item, count); base += LANES) { \
        mask live = to_mask(lane_indices(base) < count); \
        Ray ray = get_ray(rays, stride, base); \
        body \
    } \
    if (OPAL_COUNT_TESTS) \
        for (uint k = 0; k < TESTS_KINDS; k++) tests[get_global_id(0) * TESTS_KINDS + k] = counts[k];

kernel void closest_hits(SCENE_PARAMETERS, global const float *rays, global float *hits, global uint *tests, uint count, uint stride,
                    uint rays_an_item) {
    EACH_RAYS(
        Hit hit = closest_hit(&scene, ray, live);
        mask found = to_mask(hit.slot != OPAL_NONE) & live;
        uints id = triangle_id(&scene, uints_pick(found, hit.slot, (uints)(0)));
        Surface s = surface_at(&scene, ray, hit, found);
        put(hits, TRACE_T, stride, base, found ? s.t : hit.t);
        put(hits, TRACE_U, stride, base, s.u);
        put(hits, TRACE_V, stride, base, s.v);
        put_uints(hits, TRACE_TRIANGLE, stride, base, uints_pick(found, id, (uints)(OPAL_NONE)));
    )
}

kernel void any_hits(SCENE_PARAMETERS, global const float *rays, global float *hits, global uint *tests, uint count, uint stride,
                uint rays_an_item) {
    EACH_RAYS(
        mask blocked = any_hit(&scene, ray, live);
        put_uints(hits, TRACE_TRIANGLE, stride, base, uints_pick(blocked, (uints)(0), (uints)(OPAL_NONE)));
    )
}
