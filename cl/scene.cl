// scene: the scene's tables and settings as a struct of pointers that every function takes; rays, hits, random numbers.
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/list.h"
#include "scene_tables.h"
#include "shared/counters.h"
#include "shared/strategy.h"
#include "shared/types.h"

typedef struct {
    global const Settings *settings;
#define TABLE_POINTER(record, name, shown) global const record *name;
    OPAL_TABLES(TABLE_POINTER)
    uint *counters; // of each COUNTER_*; null but where the program counts
} Scene;

// The first parameters of every kernel that sees the scene, in the order in which the host sets them.
#define TABLE_PARAMETER(record, name, shown) , global const record *name
#define SCENE_PARAMETERS global const Settings *settings OPAL_TABLES(TABLE_PARAMETER)
#define TABLE_ARGUMENT(record, name, shown) , name
#define SCENE_OF_PARAMETERS {settings OPAL_TABLES(TABLE_ARGUMENT), 0}

// Adds to a counter (COUNTER_*), in programs that count.
static void add_count(const Scene *scene, uint counter, uint many) {
    if (OPAL_COUNT_TESTS) scene->counters[counter] += many;
}

// Is this the choice of that axis? A constant where the kernel is specialised, else read from the settings.
#define CHOSEN(scene, axis, choice) \
    (OPAL_AXIS_##axis < 0 ? (scene)->settings->choices[AXIS_##axis] == CHOICE_##axis##_##choice \
                          : OPAL_AXIS_##axis == CHOICE_##axis##_##choice)

#define COUNT_EMITTER(name, traits) +OPAL_HAS_emitter_##name
#define COUNT_MET(name, traits) +(OPAL_HAS_emitter_##name && OPAL_CAN_BE_MET(traits))
#define COUNT_ENVIRONMENT(name, traits) +(OPAL_HAS_emitter_##name && OPAL_IS_ENVIRONMENT(traits))
#define COUNT_INFINITE(name, traits) +(OPAL_HAS_emitter_##name && ((traits) & OPAL_INFINITE) != 0)
enum { // the kinds of emitters that this kernel has
    EMITTER_KINDS = 0 OPAL_EMITTERS(COUNT_EMITTER),
    MET_KINDS = 0 OPAL_EMITTERS(COUNT_MET),                 // that a ray can meet
    ENVIRONMENT_KINDS = 0 OPAL_EMITTERS(COUNT_ENVIRONMENT), // that a ray meets where it leaves the scene
    INFINITE_KINDS = 0 OPAL_EMITTERS(COUNT_INFINITE),
};

// Rays, one a lane. d need not be unit; a hit has tmin < t < tmax.
typedef struct {
    v3 o, d;
    real tmin, tmax;
} Ray;

// The nearest hit of each lane: its distance t; its coordinates u, v on the surface (of triangles the barycentric
// weights of corners 1 and 2; of spheres u is 1 where the ray leaves them, else 0); the shape (SHAPE_*, unset in
// kernels of one shape); and the primitive's place among the blocks of its shape: block * OPAL_WIDTH + place in the
// block, OPAL_NONE where nothing is hit. For face-list hits t is approximate and u, v are unset; surface_at computes
// all three.
typedef struct {
    real t, u, v;
    uints shape, place;
} Hit;

static mask is_hit(Hit hit) { return to_mask(hit.place != OPAL_NONE); }

static Hit hit_pick(mask m, Hit yes, Hit no) {
    Hit hit = {m ? yes.t : no.t, m ? yes.u : no.u, m ? yes.v : no.v, uints_pick(m, yes.shape, no.shape),
               uints_pick(m, yes.place, no.place)};
    return hit;
}

static Hit no_hit(real tmax) {
    Hit hit = {tmax, (real)(0), (real)(0), (uints)(0), (uints)(OPAL_NONE)};
    return hit;
}

static Ray ray_pick(mask m, Ray yes, Ray no) {
    Ray ray = {v3_pick(m, yes.o, no.o), v3_pick(m, yes.d, no.d), m ? yes.tmin : no.tmin, m ? yes.tmax : no.tmax};
    return ray;
}

// Returns `ray` through a select that cannot be optimised away, as compilers do not know that `always` is true.
// Benchmarks trace twice and compare (OPAL_REPEAT_traversal).
static Ray same_ray(Ray ray, mask always) {
    ray.o = v3_pick(always, ray.o, ray.d);
    return ray;
}

// A pair of random words by another sampler than the independent one.
static CALLED u2 bits_of_set(const Scene *scene, Sampler s, uints dimension) {
    uint seed = scene->settings->seed;
    if (CHOSEN(scene, sampler, sobol)) return sobol_pair(s, dimension, seed);
    return stratified_pair(s, dimension, scene->settings->spp, seed);
}

static u2 bits_once(const Scene *scene, Sampler s, uints dimension) {
    if (!CHOSEN(scene, sampler, independent)) return bits_of_set(scene, s, dimension);
    u3 h = pcg3d(s.key0, s.key1, dimension);
    u2 pair = {h.x, h.y};
    return pair;
}

// A pair of random words of a dimension, by the sampler that is chosen: all 32 bits, for choices among many.
static u2 draw_bits(const Scene *scene, Sampler s, uints dimension) {
    u2 bits = bits_once(scene, s, dimension);
    if (!OPAL_REPEAT_sampling) return bits;
    mask always = unit_real(bits.x) < 2;
    s.key0 = uints_pick(always, s.key0, s.key1);
    s.sample = uints_pick(always, s.sample, s.pixel);
    return bits_once(scene, s, dimension);
}

// The same pair as numbers in [0, 1).
static v2 draw(const Scene *scene, Sampler s, uints dimension) {
    u2 bits = draw_bits(scene, s, dimension);
    return v2_of(unit_real(bits.x), unit_real(bits.y));
}
