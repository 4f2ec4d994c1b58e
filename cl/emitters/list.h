// The emitters: a row, a list of parameters and a record here, one file cl/emitters/NAME.cl and one file
// host/flatten/emitter_NAME.cpp each.
#ifndef OPAL_EMITTER_LIST_H
#define OPAL_EMITTER_LIST_H

#include "shared/glue.h"

// Traits of a kind, as bits.
enum {
    OPAL_SURFACE = 1, // a ray meets it on a surface, whose mesh names it
    OPAL_DELTA = 2,   // seen in one direction from each point: no ray meets it by chance
    OPAL_INFINITE = 4 // infinitely far: shadow rays have no end
};
#define OPAL_CAN_BE_MET(traits) (((traits) & OPAL_DELTA) == 0) // by a BSDF sample
// Is it met by rays that leave the scene? A scene has one such light at most.
#define OPAL_IS_ENVIRONMENT(traits) (((traits) & (OPAL_INFINITE | OPAL_DELTA)) == OPAL_INFINITE)

// EMITTER(name, traits). Emitters of meshes: the shape and its <emitter type="area"> describe them.
#define OPAL_MESH_EMITTERS(EMITTER) \
    EMITTER(mesh, OPAL_SURFACE)          /* a triangle mesh that emits */ \
    EMITTER(parallelogram, OPAL_SURFACE) /* a parallelogram that emits, sampled as one piece */ \
    EMITTER(sphere, OPAL_SURFACE)        /* a sphere that emits, sampled by the cone that it fills */

// Emitters of scenes: NAME is also the XML type.
#define OPAL_SCENE_EMITTERS(EMITTER) \
    EMITTER(point, OPAL_DELTA)      /* a point that emits alike in all directions */ \
    EMITTER(constant, OPAL_INFINITE) /* an environment of one radiance */ \
    EMITTER(spot, OPAL_DELTA)        /* a point that emits into a cone */ \
    EMITTER(directional, OPAL_DELTA | OPAL_INFINITE) /* parallel light, as that of the sun */

#define OPAL_EMITTERS(EMITTER) OPAL_MESH_EMITTERS(EMITTER) OPAL_SCENE_EMITTERS(EMITTER)

// Their parameters in the scene file (shared/parameters.h), from which the host makes the struct emitter_NAME.
#define OPAL_EMITTER_point(PARAMETER) \
    PARAMETER(POINT, position, "position", REQUIRED, ANY, "position") \
    PARAMETER(COLOR, power, "power", REQUIRED, AT_LEAST(0), "power, W; the intensity is power / (4 pi)")

#define OPAL_EMITTER_constant(PARAMETER) \
    PARAMETER(COLOR, radiance, "radiance", 1, AT_LEAST(0), "radiance, W / (m^2 sr)")

#define OPAL_EMITTER_spot(PARAMETER) \
    PARAMETER(POINT, position, "position", REQUIRED, ANY, "position") \
    PARAMETER(VECTOR, direction, "direction", REQUIRED, ANY, "where its axis points to") \
    PARAMETER(COLOR, intensity, "intensity", 1, AT_LEAST(0), "intensity within the beam, W / sr") \
    PARAMETER(NUMBER, cutoff_angle, "cutoffAngle", 20, BETWEEN(0, 180), \
              "angle from the axis at which the light ends, degrees") \
    PARAMETER(NUMBER, beam_width, "beamWidth", 15, BETWEEN(0, 180), \
              "angle from the axis up to which the intensity is full, degrees; 3/4 of a cutoffAngle that is given") \
    PARAMETER(FLAG, smooth, "smooth", false, ANY, \
              "whether it falls by the fourth power of the cosine's share (pbrt), else with the angle (Mitsuba)")

#define OPAL_EMITTER_directional(PARAMETER) \
    PARAMETER(VECTOR, direction, "direction", REQUIRED, ANY, "where the light goes to") \
    PARAMETER(COLOR, irradiance, "irradiance", 1, AT_LEAST(0), "irradiance across the direction, W / m^2")

#define OPAL_EMITTER_ENUM(name, traits) EMITTER_##name,
enum { OPAL_EMITTERS(OPAL_EMITTER_ENUM) EMITTER_COUNT };

#ifdef __cplusplus
namespace opal {
#endif

#define OPAL_ALIAS_ROWS 0x100000u // an alias table of more rows is drawn from by 32 bits, others by 24

// The records of the kinds. All begin with a colour: the radiance, W / (m^2 sr), or of a delta light the intensity,
// W / sr, times FlatScene::scale^2. Positions and areas are in the flattened scene's units (FlatScene::center,
// FlatScene::scale).
typedef struct {
    float color[3];
    uint first_triangle;  // index of the first of its triangles, whose rows follow their order
} emitter_mesh_record;

typedef struct {
    float color[3];
    float origin[3];      // a corner
    float u[3], v[3];     // the edges from there
    float normal[3];      // u x v, unit; it emits on that side
    float area;
    uint uv_exchanged;    // 1: texture coordinate u grows along the edge v, and v along u
} emitter_parallelogram_record;

typedef struct {
    float color[3];
    float position[3];
} emitter_point_record;

typedef struct {
    float color[3];
} emitter_constant_record;

typedef struct {
    float color[3];
    float center[3];
    float radius;
    uint inward;          // 1: it emits inside
    uint sphere;          // its index among the spheres
} emitter_sphere_record;

typedef struct {
    float color[3];
    float position[3];
    float direction[3];       // unit
    float cutoff_angle;       // radians
    float inverse_transition; // 1 / (cutoff_angle - beam width); if smooth, 2 / (cosine of the beam - of the cutoff)
    uint smooth;              // 1: it falls as in pbrt, 0: in proportion to the angle
    float across[2][3];       // the texture's axes: unit vectors across the direction, over 2 tan cutoff_angle
} emitter_spot_record;

typedef struct {
    float color[3];
    float direction[3];   // unit, where the light goes to
} emitter_directional_record;

// One emitter. Lanes read the record of a kind from emitters of another kind too, and drop what they read: a member
// that is an index into a table must stand before `u`, or be used in the kind's own lanes alone. The members of `u`
// have a prefix, as "constant" is a keyword.
#define OPAL_EMITTER_MEMBER(name, traits) emitter_##name##_record of_##name;
typedef struct {
    uint kind;            // EMITTER_*
    float probability;    // of choosing it (--emitter-choice), as the alias table and the random numbers' grid have it
    float accept;         // alias table: keep this row if a uniform number is below, else take row `other`
    uint other;
    uint two_sided;       // of a mesh: 1, it emits on both sides
    uint texture;         // first word of what multiplies its colour, or OPAL_UNTEXTURED
    uint first, count;    // its rows of a table; of a mesh, of the light triangles. Others: 0, 0
    union {
        float color[3];   // with which every record begins
        OPAL_EMITTERS(OPAL_EMITTER_MEMBER)
    } u;
} EmitterRecord;

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
