// The emitters: one row and one file cl/emitters/NAME.cl each.
#ifndef OPAL_EMITTER_LIST_H
#define OPAL_EMITTER_LIST_H

#include "shared/glue.h"

// Traits, as bits.
enum {
    OPAL_SURFACE = 1,  // a ray meets it on a surface, whose mesh names it
    OPAL_DELTA = 2,    // seen in one direction from each point: no ray meets it by chance
    OPAL_INFINITE = 4, // infinitely far: shadow rays have no end
};
#define OPAL_CAN_BE_MET(traits) (((traits) & OPAL_DELTA) == 0) // by a BSDF sample
// Is it met by rays that leave the scene?
#define OPAL_IS_ENVIRONMENT(traits) (((traits) & (OPAL_INFINITE | OPAL_DELTA)) == OPAL_INFINITE)

// EMITTER(name, traits)
#define OPAL_EMITTERS(EMITTER) \
    EMITTER(mesh, OPAL_SURFACE)          /* a triangle mesh that emits */ \
    EMITTER(parallelogram, OPAL_SURFACE) /* a parallelogram that emits, sampled as one piece */ \
    EMITTER(point, OPAL_DELTA)           /* a point */

#define OPAL_EMITTER_ENUM(name, traits) EMITTER_##name,
enum { OPAL_EMITTERS(OPAL_EMITTER_ENUM) EMITTER_COUNT };

#ifdef __cplusplus
namespace opal {
#endif

#define OPAL_ALIAS_ROWS 0x100000u // an alias table of more rows is drawn from by 32 bits, others by 24

// One emitter. Positions and areas are in the flattened scene's units (FlatScene::center, FlatScene::scale).
typedef struct {
    uint kind;            // EMITTER_*
    float radiance[3];    // W / (m^2 sr); point: intensity, W / sr, times FlatScene::scale^2
    float origin[3];      // parallelogram: a corner; point: its position
    float area;           // of the whole emitter
    float inverse_area;   // 1 / area
    float u[3], v[3];     // parallelogram: its edges
    float normal[3];      // parallelogram: u x v, unit; it emits on that side
    uint first, count;    // mesh: its rows of the light triangles, in the order of its triangles
    uint first_triangle;  // mesh: index of the first of these triangles
    float probability;    // of choosing it (--emitter-choice), as the alias table and the random numbers' grid have it
    float accept;         // alias table: keep this row if a uniform number is below, else take row `other`
    uint other;
} EmitterRecord;
OPAL_SIZE_CHECK(EmitterRecord, 96);

// One triangle of a mesh light, with its row of the mesh's alias table (Vose 1991). `other` counts from the mesh's
// first.
typedef struct {
    uint slot;            // its place in the blocks: block slot / 8, place slot % 8
    float accept;
    uint other;
    float inverse_pdf;    // 1 / pdf of a point on it, area measure, given the light: area / probability of choosing it
} LightTriangle;
OPAL_SIZE_CHECK(LightTriangle, 16);

#ifdef __cplusplus
}
#endif

#endif
