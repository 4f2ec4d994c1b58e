// rays: traversal alone, on rays like those of a render (host/bench/rays.h).
//
// Rays and hits are columns (sample_columns.cl) of `stride` floats, a multiple of 16; kernels/rays_list.h names the
// columns.
#include "cameras/dispatch.cl"
#include "cameras/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"
#include "emitters/choice.cl"
#include "emitters/dispatch.cl"
#include "emitters/interface.cl"
#include "kernels/sample_columns.cl"
#include "kernels/rays_list.h"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "shared/counters.h"
#include "shared/types.h"
#include "surface.cl"
#include "trace/trace.cl"

static Ray get_ray(global const float *rays, uint stride, uint base) {
    Ray ray = {get_v3(rays, TRACE_O_X, stride, base), get_v3(rays, TRACE_D_X, stride, base),
               get(rays, TRACE_TMIN, stride, base), get(rays, TRACE_TMAX, stride, base)};
    return ray;
}

static void put_ray(global float *rays, uint stride, uint base, Ray ray, mask active) {
    put_v3(rays, TRACE_O_X, stride, base, ray.o);
    put(rays, TRACE_TMIN, stride, base, ray.tmin);
    put_v3(rays, TRACE_D_X, stride, base, ray.d);
    put(rays, TRACE_TMAX, stride, base, active ? ray.tmax : (real)(-1));
}

// Camera rays, one a pixel, in square tiles of this side; the film's sides are multiples of it.
#define RAYS_TILE 8
static Ray tiled_camera_ray(const Scene *scene, Sampler sampler, uints i) {
    uint columns = scene->settings->width / RAYS_TILE;
    uints tile = i / (uint)(RAYS_TILE * RAYS_TILE), row = tile / columns;
    uints x = (tile - row * columns) * RAYS_TILE + i % (uint)(RAYS_TILE);
    uints y = row * RAYS_TILE + i / (uint)(RAYS_TILE) % (uint)(RAYS_TILE);
    return camera_ray(scene, x, y, film_offset(scene, sampler), lens_numbers(scene, sampler));
}

// A cosine-distributed ray into the hemisphere around `normal`.
static Ray bounce_ray(const Scene *scene, Sampler sampler, const Surface *s, v3 normal) {
    v3 d = to_world(frame_of(normal), square_to_cosine_hemisphere(draw(scene, sampler, (uints)(1 + DIM_BSDF))));
    Ray ray = {leave_surface(s, d), d, (real)(0), (real)(FAR)};
    return ray;
}

// A shadow ray to a light, as the integrators send it. Where there are no lights, it goes to a point of the box
// lo + [0, 1]^3 size. Lanes whose light faces away leave *active.
static Ray ray_to_light(const Scene *scene, Sampler sampler, const Surface *s, v3 normal, v3 lo, v3 size,
                        mask *active) {
    v2 point = draw(scene, sampler, (uints)(1 + DIM_LIGHT));
    u2 choice = draw_bits(scene, sampler, (uints)(1 + DIM_EMITTER));
    if (EMITTER_KINDS > 0) {
        ReferencePoint from = reference_point(s);
        uints id = emitter_choose(scene, from, choice).id;
        u2 triangle = draw_bits(scene, sampler, (uints)(1 + DIM_TRIANGLE));
        LightSample light = emitter_sample(scene, id, from, point, triangle, *active);
        *active = light.active & (v3_dot(normal, light.d) > 0);
        return shadow_ray(s, light);
    }
    v3 end = v3_add(lo, v3_mul(size, v3_of(point.x, point.y, unit_real(choice.x))));
    v3 start = leave_surface(s, v3_sub(end, s->p));
    Ray ray = {start, v3_sub(end, start), (real)(0), (real)(1)};
    return ray;
}

// Writes one ray a pixel, of one kind. tmax = -1: no such ray, because the camera ray met nothing or the light faces
// away. lo, size: the scene's box, in flattened units
kernel void generate(SCENE_PARAMETERS, uint kind, float lo_x, float lo_y, float lo_z, float size_x, float size_y,
                     float size_z, global float *rays, uint first, uint stride) {
    uint base = first + (uint)get_global_id(0) * LANES;
    if (base >= stride) return;
    Scene scene = SCENE_OF_PARAMETERS;
    uint counters[COUNTERS] = {0};
    scene.counters = counters;
    uints i = lane_indices(base);
    mask active = to_mask(i < settings->width * settings->height);
    Sampler sampler = sampler_start(i, (uints)(0), settings->seed);
    Ray ray = tiled_camera_ray(&scene, sampler, i);
    if (kind != RAYS_camera) {
        Hit hit = closest_hit(&scene, ray, active, NO_LANES);
        active = active & is_hit(hit);
        Surface s = no_surface();
        if (ANY(active)) s = surface_at(&scene, ray, hit, active);
        v3 normal = v3_scale(s.normal, copysign((real)(1), -v3_dot(s.normal, ray.d))); // on the side that is seen
        if (kind == RAYS_bounce) ray = bounce_ray(&scene, sampler, &s, normal);
        else ray = ray_to_light(&scene, sampler, &s, normal, v3_of((real)(lo_x), (real)(lo_y), (real)(lo_z)),
                                v3_of((real)(size_x), (real)(size_y), (real)(size_z)), &active);
    }
    put_ray(rays, stride, base, ray, active);
}

// A work-item traces rays_an_item rays, LANES at a time. These are its first ray, and the ray after its last.
static uint first_ray(uint rays_an_item) { return (uint)get_global_id(0) * rays_an_item; }
static uint end_of_rays(uint rays_an_item, uint count) { return min(first_ray(rays_an_item) + rays_an_item, count); }

// Writes a work-item's counters, where the program counts.
static void put_counters(global uint *tests, const uint *counters) {
    if (!OPAL_COUNT_TESTS) return;
    for (uint k = 0; k < COUNTERS; k++) tests[get_global_id(0) * COUNTERS + k] = counters[k];
}

// The nearest hits of `count` rays. tests: COUNTERS of each work-item
kernel void closest_hits(SCENE_PARAMETERS, global const float *rays, global float *hits, global uint *tests, uint count,
                         uint stride, uint rays_an_item) {
    Scene scene = SCENE_OF_PARAMETERS;
    uint counters[COUNTERS] = {0};
    scene.counters = counters;
    for (uint base = first_ray(rays_an_item); base < end_of_rays(rays_an_item, count); base += LANES) {
        mask active = to_mask(lane_indices(base) < count);
        Ray ray = get_ray(rays, stride, base);
        Hit hit = closest_hit(&scene, ray, active, NO_LANES);
        mask active_hit = is_hit(hit) & active;
        Surface s = no_surface();
        if (ANY(active_hit)) s = surface_at(&scene, ray, hit, active_hit);
        put(hits, TRACE_T, stride, base, active_hit ? s.t : hit.t);
        put(hits, TRACE_U, stride, base, s.u);
        put(hits, TRACE_V, stride, base, s.v);
        put_uints(hits, TRACE_TRIANGLE, stride, base, uints_pick(active_hit, s.primitive, (uints)(OPAL_NONE)));
    }
    put_counters(tests, counters);
}

// Which of `count` rays hit anything.
kernel void any_hits(SCENE_PARAMETERS, global const float *rays, global float *hits, global uint *tests, uint count,
                     uint stride, uint rays_an_item) {
    Scene scene = SCENE_OF_PARAMETERS;
    uint counters[COUNTERS] = {0};
    scene.counters = counters;
    for (uint base = first_ray(rays_an_item); base < end_of_rays(rays_an_item, count); base += LANES) {
        mask active = to_mask(lane_indices(base) < count);
        mask blocked = any_hit(&scene, get_ray(rays, stride, base), active);
        put_uints(hits, TRACE_TRIANGLE, stride, base, uints_pick(blocked, (uints)(0), (uints)(OPAL_NONE)));
    }
    put_counters(tests, counters);
}
