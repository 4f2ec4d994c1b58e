// scene: the buffers, gathered once into a struct of pointers that every function takes.
#include "shared/types.h"
#include "shared/features.h"

typedef struct {
    global const Settings *settings;
    global const BvhNode *nodes;
    global const TriangleBlock *blocks;
    global const Triangle *triangles;
    global const float *normals;
    global const float *listed_vertices;
    global const ListedFace *listed_faces;
    global const MeshRecord *meshes;
    global const BsdfRecord *bsdfs;
    global const EmitterRecord *emitters;
    global const LightTriangle *light_triangles;
    uint *tests;   // how many of each kind of TESTS_*; null but where they are counted
} Scene;

// Counted where the program is built for it (BuildOptions::count_tests): what walks of the tree test beside its root; rays; rounds of a
// work-item's loop, each of LANES rays at most.
enum { TESTS_nodes, TESTS_blocks, TESTS_rays, TESTS_shadow_rays, TESTS_rounds, TESTS_KINDS };
#define COUNT_TESTS(scene, kind, many) if (OPAL_COUNT_TESTS) (scene)->tests[TESTS_##kind] += (many)

// Every kernel that sees the scene has these parameters, in the order in which the host sets them (host/render/scene_buffers.cpp).
#define SCENE_PARAMETERS \
    global const Settings *settings, global const BvhNode *nodes, global const TriangleBlock *blocks, \
        global const Triangle *triangles, global const float *normals, global const float *listed_vertices, \
        global const ListedFace *listed_faces, global const MeshRecord *meshes, global const BsdfRecord *bsdfs, \
        global const EmitterRecord *emitters, global const LightTriangle *light_triangles
#define SCENE_OF_PARAMETERS \
    {settings, nodes, blocks, triangles, normals, listed_vertices, listed_faces, meshes, bsdfs, emitters, light_triangles, 0}

// Is this the choice of that axis? A constant where the kernel is specialised, else read from the settings.
#define CHOSEN(scene, axis, choice) \
    (OPAL_AXIS_##axis < 0 ? (scene)->settings->choices[AXIS_##axis] == CHOICE_##axis##_##choice \
                          : OPAL_AXIS_##axis == CHOICE_##axis##_##choice)

// Rays, one a lane. d need not be unit; a hit has tmin < t < tmax.
typedef struct {
    v3 o, d;
    real tmin, tmax;
} Ray;

// The nearest hit of each lane: its distance, barycentric weights of corners 1 and 2, and the triangle's slot (block * 8 + place); slot =
// OPAL_NONE: none. Of listed triangles t is as good as their planes' roundings, and u and v are not set: surface_at has all three.
typedef struct {
    real t, u, v;
    uints slot;
} Hit;

// The same ray, which no compiler can know: `always` is true. To trace it twice and see what once costs (BuildOptions::twice).
static Ray same_ray(Ray ray, mask always) {
    ray.o = v3_pick(always, ray.o, ray.d);
    return ray;
}

static u2 bits_once(const Scene *scene, Sampler s, uints dimension) {
    if (CHOSEN(scene, sampler, sobol)) return sobol_pair(s, dimension, scene->settings->seed);
    if (CHOSEN(scene, sampler, stratified)) return stratified_pair(s, dimension, scene->settings->spp, scene->settings->seed);
    u3 h = pcg3d(s.key0, s.key1, dimension);
    u2 pair = {h.x, h.y};
    return pair;
}

// A pair of random words of a dimension, by the chosen sampler: 32 bits each, for choices among many.
static u2 draw_bits(const Scene *scene, Sampler s, uints dimension) {
    u2 bits = bits_once(scene, s, dimension);
    if (!OPAL_TWICE_sampling) return bits;
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
