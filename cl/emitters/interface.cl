// interface: what every emitter offers (emitters/NAME.cl for each row of emitters/list.h), one a lane.
//   LightSample emitter_NAME_sample(scene, id, color, from, u, bits)
//                                          a direction from `from` to the emitters `id`
//   v3   emitter_NAME_radiance(scene, id, color, d, s)
//                                          radiance that a ray of direction d (unit) finds; 0 for delta lights
//   real emitter_NAME_pdf(scene, id, from, d, s)
//                                          density of _sample at d, solid angle measure, 1/sr; 0 for delta lights
// color: that of the record; of lights on surfaces _radiance gets it times their texture. u: a pair of random numbers
// in [0, 1); bits: a pair of random words, for choices among many. s: the surface that the ray met; of lights that are
// infinitely far nothing.
// Functions compute all lanes; their callers pick those that are meant, but all lanes of a LightSample are finite.
// _radiance and _pdf of delta lights are never called.
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "surface.cl"
#include "textures/dispatch.cl"
#include "textures/interface.cl"

// The point from which light is seen. Lengths are those of the flattened scene.
typedef struct {
    v3 p; // position
    v3 n; // shading normal, unit; 0 in free space
} ReferencePoint;

static ReferencePoint reference_point(const Surface *s) {
    ReferencePoint from = {s->p, s->frame.n};
    return from;
}

// A direction from a reference point to a light.
typedef struct {
    v3 d;             // unit
    real distance;    // of the light; FAR where it is infinitely far
    v3 radiance;      // towards the reference point, W / (m^2 sr); of a delta light the irradiance across d, W / m^2
    real inverse_pdf; // 1 / pdf of d, solid angle measure, given the light; of a delta light 1. The inverse survives
                      // densities that overflow near a light.
    v3 end;           // of the shadow ray; unset where the light is infinitely far
    mask active;      // the light is seen from there unless something is between
    mask discrete, infinite; // traits of the light (OPAL_DELTA, OPAL_INFINITE), which dispatch.cl sets
} LightSample;

static LightSample light_sample_of(v3 d, real distance, v3 radiance, real inverse_pdf, v3 end, mask active) {
    LightSample s = {d, distance, radiance, inverse_pdf, end, active, NO_LANES, NO_LANES};
    return s;
}

static LightSample no_light_sample() {
    v3 zero = v3_all((real)(0));
    return light_sample_of(zero, (real)(0), zero, (real)(0), zero, NO_LANES);
}

static LightSample light_sample_pick(mask m, LightSample yes, LightSample no) {
    LightSample s = {v3_pick(m, yes.d, no.d), m ? yes.distance : no.distance, v3_pick(m, yes.radiance, no.radiance),
                     m ? yes.inverse_pdf : no.inverse_pdf, v3_pick(m, yes.end, no.end), m ? yes.active : no.active,
                     m ? yes.discrete : no.discrete, m ? yes.infinite : no.infinite};
    return s;
}

// The lanes whose emitter `id` is of that kind (EMITTER_*). dispatch.cl knows the lanes that are meant.
static mask is_emitter(const Scene *scene, uints id, uint kind) {
    return to_mask(GATHER(uints, scene->emitters, id, .kind) == kind);
}

// `color` times the texture of the emitters `id` of that kind at `point`, in kernels whose lights have textures.
static v3 textured_light(const Scene *scene, uints id, uint kind, v3 color, TexturePoint point) {
    if (!OPAL_HAS_light_textures) return color;
    uints texture = GATHER(uints, scene->emitters, id, .texture);
    return v3_mul(color, texture_color(scene, texture, point, is_emitter(scene, id, kind)));
}

// Where direction d, away from the light, meets a plane across the axis: 0.5, 0.5 in the middle. x, y: vectors across
// the axis, over the size of the unit square at distance 1
static v2 plane_uv(v3 d, v3 axis, v3 x, v3 y) {
    real depth = v3_dot(d, axis);
    return v2_of(R(0.5) + v3_dot(d, x) / depth, R(0.5) + v3_dot(d, y) / depth);
}
