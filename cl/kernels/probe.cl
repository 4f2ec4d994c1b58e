// probe: the functions that rendering uses, one by one, on random numbers, points and rays of the host's choice: what
// the tests ask is what renders.
//
// A work-item carries LANES samples, from index first + item * LANES on. Inputs and outputs are columns
// (sample_columns.cl) of `stride` floats, a multiple of 16. Drivers compile a kernel for each shape of launch, so that
// all launches have one: work-items past the end return.
#include "bsdfs/dispatch.cl"
#include "bsdfs/interface.cl"
#include "cameras/dispatch.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/warp.cl"
#include "emitters/choice.cl"
#include "emitters/dispatch.cl"
#include "emitters/interface.cl"
#include "kernels/sample_columns.cl"
#include "kernels/probe_list.h"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "shared/types.h"
#include "surface.cl"
#include "trace/trace.cl"

// Index of a work-item's first sample.
static uint base_of_item(uint first) { return first + (uint)get_global_id(0) * LANES; }

// The numbers of dimensions first_dimension ... of sample i * sample_step of pixel i * pixel_step, by the settings'
// sampler.
kernel void numbers(SCENE_PARAMETERS, uint pixel_step, uint sample_step, uint first_dimension, global float *out,
                    uint first, uint stride) {
    uint base = base_of_item(first);
    if (base >= stride) return;
    Scene scene = SCENE_OF_PARAMETERS;
    uints i = lane_indices(base);
    Sampler sampler = sampler_start(i * pixel_step, i * sample_step, settings->seed);
    for (uint pair = 0; pair < OPAL_PROBE_PAIRS; pair++) {
        v2 u = draw(&scene, sampler, (uints)(first_dimension + pair));
        put(out, 2 * pair, stride, base, u.x);
        put(out, 2 * pair + 1, stride, base, u.y);
    }
}

kernel void warp_sample(int which, float parameter, global const float *given, global float *out, uint first,
                        uint stride) {
    uint base = base_of_item(first);
    if (base >= stride) return;
    v2 u = get_v2(given, 0, stride, base);
    v3 p = v3_all((real)(0));
#define SAMPLE_PLANE(name, domain) \
    if (which == WARP_##name) { \
        v2 q = square_to_##name(u); \
        p = v3_of(q.x, q.y, (real)(0)); \
    }
#define SAMPLE_DIRECTION(name, domain) if (which == WARP_##name) p = square_to_##name(u);
#define SAMPLE_LOBE(name, domain, meaning, otherwise) \
    if (which == WARP_##name) p = square_to_##name(u, (real)(parameter));
    OPAL_WARPS(SAMPLE_PLANE, SAMPLE_DIRECTION, SAMPLE_LOBE)
    put_v3(out, WARP_X, stride, base, p);
}

kernel void warp_pdf(int which, float parameter, global const float *points, global float *out, uint first,
                     uint stride) {
    uint base = base_of_item(first);
    if (base >= stride) return;
    v3 p = get_v3(points, WARP_X, stride, base);
    real pdf = 0;
#define PDF_PLANE(name, domain) if (which == WARP_##name) pdf = square_to_##name##_pdf(v2_of(p.x, p.y));
#define PDF_DIRECTION(name, domain) if (which == WARP_##name) pdf = square_to_##name##_pdf(p);
#define PDF_LOBE(name, domain, meaning, otherwise) \
    if (which == WARP_##name) pdf = square_to_##name##_pdf(p, (real)(parameter));
    OPAL_WARPS(PDF_PLANE, PDF_DIRECTION, PDF_LOBE)
    put(out, 0, stride, base, pdf);
}

// A surface of a mesh in the plane z = 0, seen from wi, at uv = 0, which grow along x and y by 1 over a length of 2.
static Surface flat_surface(const Scene *scene, uint mesh, float wi_x, float wi_y, float wi_z) {
    real zero = 0, one = 1;
    Surface s = no_surface();
    s.frame.s = v3_of(one, zero, zero);
    s.frame.t = v3_of(zero, one, zero);
    s.frame.n = s.normal = v3_of(zero, zero, one);
    s.wi = v3_of((real)(wi_x), (real)(wi_y), (real)(wi_z));
    s.dpdu = v3_of(2 * one, zero, zero);
    s.dpdv = v3_of(zero, 2 * one, zero);
    s.bsdf = (uints)(scene->meshes[mesh].bsdf);
    bsdf_open(scene, &s, ALL_LANES);
    return s;
}

kernel void bsdf_draw(SCENE_PARAMETERS, uint mesh, float wi_x, float wi_y, float wi_z, global const float *given,
                      global float *out, uint first, uint stride) {
    uint base = base_of_item(first);
    if (base >= stride) return;
    Scene scene = SCENE_OF_PARAMETERS;
    Surface surface = flat_surface(&scene, mesh, wi_x, wi_y, wi_z);
    BsdfNumbers numbers = {get_v2(given, 0, stride, base), get(given, 2, stride, base), (real)(0), (real)(0)};
    if (OPAL_HAS_bsdf_mask) numbers.met = get(given, 3, stride, base);
    if (OPAL_HAS_bsdf_blendbsdf) numbers.leaf = get(given, 4, stride, base);
    BsdfSample s = bsdf_sample(&scene, &surface, numbers, ALL_LANES);
    put_v3(out, BSDF_WO_X, stride, base, to_world(surface.frame, s.wo));
    put_v3(out, BSDF_WEIGHT_R, stride, base, s.weight);
    put(out, BSDF_PDF, stride, base, s.pdf);
    put(out, BSDF_ETA, stride, base, s.eta);
    put(out, BSDF_DISCRETE, stride, base, s.discrete ? (real)(1) : (real)(0));
}

kernel void bsdf_value(SCENE_PARAMETERS, uint mesh, float wi_x, float wi_y, float wi_z, global const float *points,
                       global float *out, uint first, uint stride) {
    uint base = base_of_item(first);
    if (base >= stride) return;
    Scene scene = SCENE_OF_PARAMETERS;
    Surface surface = flat_surface(&scene, mesh, wi_x, wi_y, wi_z);
    v3 point = get_v3(points, WARP_X, stride, base), wo = to_local(surface.frame, point);
    BsdfResponse r = bsdf_respond(&scene, &surface, wo, ALL_LANES, no_numbers(), NO_LANES);
    if (OPAL_HAS_bsdf_blendbsdf + OPAL_PERTURBATIONS > 0) // the cosine is that of the mesh's own normal
        r.f = v3_scale(r.f, r.cosine / fabs(point.z));
    put_v3(out, EVAL_R, stride, base, r.f);
    put(out, EVAL_PDF, stride, base, r.pdf);
}

// Random words whose upper 24 bits are these numbers (unit_real).
static u2 bits_of(v2 u) {
    u2 bits = {to_uints(u.x * GRID) << 8, to_uints(u.y * GRID) << 8};
    return bits;
}

// Directions from points in free space to chosen emitters; the density is that of both choices.
kernel void light_draw(SCENE_PARAMETERS, global const float *points, global const float *given, global float *out,
                       uint first, uint stride) {
    uint base = base_of_item(first);
    if (base >= stride) return;
    Scene scene = SCENE_OF_PARAMETERS;
    ReferencePoint from = {get_v3(points, 0, stride, base), v3_all((real)(0))};
    EmitterChoice choice = emitter_choose(&scene, from, bits_of(get_v2(given, 0, stride, base)));
    LightSample s = emitter_sample(&scene, choice.id, from, get_v2(given, 2, stride, base),
                                   bits_of(get_v2(given, 4, stride, base)), ALL_LANES);
    put_v3(out, LIGHT_D_X, stride, base, s.d);
    put(out, LIGHT_DISTANCE, stride, base, s.distance);
    put_v3(out, LIGHT_RADIANCE_R, stride, base, s.radiance);
    put(out, LIGHT_DENSITY, stride, base, choice.probability / s.inverse_pdf);
    put_uints(out, LIGHT_ID, stride, base, choice.id);
    put(out, LIGHT_ACTIVE, stride, base, s.active ? (real)(1) : (real)(0));
}

// The camera's rays through points of the film in [0, 1]^2, by pairs of numbers for the lens.
kernel void camera_rays(SCENE_PARAMETERS, global const float *given, global float *out, uint first, uint stride) {
    uint base = base_of_item(first);
    if (base >= stride) return;
    Scene scene = SCENE_OF_PARAMETERS;
    v2 film = get_v2(given, FILM_X, stride, base);
    v2 pixels = v2_of(film.x * (real1)settings->width, film.y * (real1)settings->height);
    Ray ray = camera_ray(&scene, (uints)(0), (uints)(0), pixels, get_v2(given, FILM_LENS, stride, base));
    put_v3(out, RAY_O_X, stride, base, ray.o);
    put_v3(out, RAY_D_X, stride, base, ray.d);
    put(out, RAY_TMIN, stride, base, ray.tmin);
    put(out, RAY_TMAX, stride, base, ray.tmax);
}

// Closest and any hit of rays; the surface; the light that a ray of unit direction meets: its radiance, and the
// density, solid angle measure, with which light sampling at the ray's origin finds that direction.
kernel void trace(SCENE_PARAMETERS, global const float *rays, global float *out, uint first, uint stride) {
    uint base = base_of_item(first);
    if (base >= stride) return;
    Scene scene = SCENE_OF_PARAMETERS;
    Ray ray = {get_v3(rays, RAY_O_X, stride, base), get_v3(rays, RAY_D_X, stride, base),
               get(rays, RAY_TMIN, stride, base), get(rays, RAY_TMAX, stride, base)};
    Hit hit = closest_hit(&scene, ray, ALL_LANES, NO_LANES);
    mask active = is_hit(hit);
    Surface s = no_surface();
    if (ANY(active)) s = surface_at(&scene, ray, hit, active);
    ReferencePoint from = {ray.o, v3_all((real)(0))};
    mask met;
    uints id = emitter_met(&scene, &s, active, ALL_LANES, &met);
    v3 radiance = v3_all((real)(0));
    real density = 0;
    if (MET_KINDS > 0 && ANY(met)) {
        radiance = emitter_radiance(&scene, id, ray.d, &s, met);
        density = emitter_pdf(&scene, id, from, ray.d, &s, met) * emitter_probability(&scene, id, from);
    }
    put(out, HIT_T, stride, base, active ? s.t : hit.t);
    put(out, HIT_U, stride, base, s.u);
    put(out, HIT_V, stride, base, s.v);
    put_uints(out, HIT_SLOT, stride, base, hit.place);
    put(out, HIT_ANY, stride, base, any_hit(&scene, ray, ALL_LANES) ? (real)(1) : (real)(0));
    put_uints(out, HIT_EMITTER, stride, base, uints_pick(met, id, (uints)(OPAL_NONE)));
    put_v3(out, HIT_RADIANCE_R, stride, base, radiance);
    put(out, HIT_LIGHT_DENSITY, stride, base, density);
    put_v3(out, HIT_P_X, stride, base, s.p);
    put_v3(out, HIT_NORMAL_X, stride, base, s.normal);
    put(out, HIT_RAY_OFFSET, stride, base, s.ray_offset);
    put(out, HIT_UV_U, stride, base, s.uv.x);
    put(out, HIT_UV_V, stride, base, s.uv.y);
    v3 none = v3_all((real)(0));
    put_v3(out, HIT_DPDU_X, stride, base, OPAL_HAS_tangents ? s.dpdu : none);
    put_v3(out, HIT_DPDV_X, stride, base, OPAL_HAS_tangents ? s.dpdv : none);
}
