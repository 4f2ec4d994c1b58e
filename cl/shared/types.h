// The records that host and device share, apart from shapes, BSDFs, textures and emitters (shapes/list.h and so on).
#ifndef OPAL_TYPES_H
#define OPAL_TYPES_H

#include "shared/glue.h"
#include "shared/strategy.h"

#ifdef __cplusplus
namespace opal {
#endif

#define OPAL_NONE 0xffffffffu        // no emitter, no normal, no hit, no depth limit
#define OPAL_LEVELS 24               // most levels of a tree, its root included
#define OPAL_WIDTH 8                 // children of a node, primitives of a block
#define OPAL_FACE_LIST_TRIANGLES 48  // most triangles of the face list, which is tested beside the tree ...
#define OPAL_FACE_LIST_VERTICES 96   // ... and its most distinct vertices

// A child of a node that is a leaf: OPAL_LEAF | shape << OPAL_SHAPE_SHIFT | index in that shape's table of blocks. All
// primitives of a leaf are of one shape (SHAPE_*, shapes/list.h).
#define OPAL_LEAF 0x80000000u
#define OPAL_SHAPE_SHIFT 28
#define OPAL_SHAPE_BITS 7u
#define OPAL_BLOCK_BITS 0x0fffffffu

// A node of the 8-wide tree: its children's boxes, one axis and side a row, and the children themselves: the index of a
// node, or a leaf. Unused children come last; they are OPAL_NONE and have lo = +inf, hi = -inf, which a slab test
// misses as long as it picks near and far by the direction's signs (sorting the two distances would hit). The first
// node is the root.
typedef struct {
    float lo[3][OPAL_WIDTH];
    float hi[3][OPAL_WIDTH];
    uint child[OPAL_WIDTH];
} BvhNode;
OPAL_SIZE_CHECK(BvhNode, 224);

// A face of the face list: a triangle A B C, or a plane convex quadrilateral A B D C that stands for the triangles A B
// C and D C B. Face i has the slot face_list_slot + 2 i, and for D C B the next one.
typedef struct {
    uint corner[4];         // A, B, C, and D (a triangle: B again): indices into the face list's vertices
    float normal[3], along; // the plane normal . p = along, with a unit normal
} FaceRecord;
OPAL_SIZE_CHECK(FaceRecord, 32);

// The first faces of the face list: how many, and how many vertices they need.
typedef struct {
    uint faces, vertices;
} FaceRange;
OPAL_SIZE_CHECK(FaceRange, 8);

// A mesh: the first word of its BSDF's record, and the index of its emitter or OPAL_NONE.
typedef struct {
    uint bsdf, emitter;
} MeshRecord;
OPAL_SIZE_CHECK(MeshRecord, 8);

#define OPAL_FILTERS(FILTER) FILTER(box) FILTER(tent) FILTER(gaussian) FILTER(mitchell) FILTER(lanczos)
#define OPAL_FILTER_ENUM(name) FILTER_##name,
enum { OPAL_FILTERS(OPAL_FILTER_ENUM) FILTER_COUNT };

// A window of the image, in pixels from its top left.
typedef struct {
    uint left, top, width, height;
} PixelWindow;
OPAL_SIZE_CHECK(PixelWindow, 16);

// All numbers of a scene that are no table. Positions are in the flattened scene's units.
typedef struct {
    uint width, height;             // of the whole image, pixels
    PixelWindow film;               // what is rendered of it: all, or a crop and what its filter needs around it
    uint spp;                       // samples of a pixel in the whole render (the strata of --sampler stratified)
    uint seed;
    FaceRange face_list;            // all of it
    FaceRange face_list_to_light;   // the faces that may occlude a light
    uint face_list_slot;            // of the face list's first triangle: block * 8
    uint emitter_count;
    uint environment;               // the emitter that rays meet where they leave the scene, or OPAL_NONE
    uint max_depth;                 // most segments of a path (1: emitters, 2: direct light); OPAL_NONE: no limit
    uint rr_depth;                  // roulette starts when a path has this many segments
    float rr_prob;                  // --rr fixed: probability to survive, a multiple of 2^-24 as random numbers are
    float rr_max;                   // --rr throughput: greatest probability to survive, a multiple of 2^-24
    uint emitter_samples, bsdf_samples; // of direct_lighting: how many of each kind
    uint lights_reflect;            // direct_lighting: surfaces that emit gather light, too (1)
    uint normals_signed;            // integrator normals: n/2 + 1/2 (1) or |n| (0)
    float visibility_length;        // integrator av: how far it looks
    float light_position[3];        // integrator simple
    float light_energy[3];          // integrator simple, W, times FlatScene::scale^2
    int filter;                     // FILTER_*
    float filter_radius;            // pixels
    float filter_stddev;            // gaussian, pixels
    float filter_b, filter_c;       // mitchell
    int choices[AXIS_COUNT];        // CHOICE_* of each axis; read by the general kernel only
} Settings;
OPAL_SIZE_CHECK(Settings, 140 + 4 * AXIS_COUNT);

#ifdef __cplusplus
}
#endif

#endif
