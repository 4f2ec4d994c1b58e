// The shapes that the tree's leaves hold: one row with the record of its blocks, and one file cl/shapes/NAME.cl each.
#ifndef OPAL_SHAPE_LIST_H
#define OPAL_SHAPE_LIST_H

#include "shared/types.h"

#define OPAL_SHAPES(SHAPE) \
    SHAPE(triangle, TriangleBlock) \
    SHAPE(sphere, SphereBlock)

#define OPAL_SHAPE_ENUM(name, Block) SHAPE_##name,
enum { OPAL_SHAPES(OPAL_SHAPE_ENUM) SHAPE_COUNT };

// The shapes' tables, as rows of OPAL_TABLES (scene_tables.h): NAME_blocks of each shape, and what else it needs.
#define OPAL_SHAPE_TABLES(TABLE) \
    TABLE(TriangleBlock, triangle_blocks, "triangle blocks") \
    TABLE(Triangle, triangles, "triangles") \
    TABLE(TriangleUv, triangle_uvs, "uv of triangles") \
    TABLE(SphereBlock, sphere_blocks, "sphere blocks") \
    TABLE(SphereFrame, sphere_frames, "frames of spheres")

#ifdef __cplusplus
namespace opal {
#endif

// Eight triangles: vertex[corner][axis][place]. Unused places come last. They repeat one point, which no ray hits, and
// have id OPAL_NONE.
typedef struct {
    float vertex[3][3][OPAL_WIDTH];
    uint id[OPAL_WIDTH];  // index into the Triangle array
} TriangleBlock;
OPAL_SIZE_CHECK(TriangleBlock, 320);

// A triangle's attributes for shading, beside its vertices.
typedef struct {
    uint normal[3];       // of each corner, an index into the normals (3 floats each); OPAL_NONE: use the geometric one
    uint mesh;
} Triangle;
OPAL_SIZE_CHECK(Triangle, 16);

// The texture coordinates of a triangle's corners, in scenes that need them.
typedef struct {
    float corner[3][2];
} TriangleUv;
OPAL_SIZE_CHECK(TriangleUv, 24);

// Eight spheres. Unused places come last. They repeat the first sphere and have id OPAL_NONE.
typedef struct {
    float center[3][OPAL_WIDTH];
    float radius[OPAL_WIDTH];
    uint inward[OPAL_WIDTH]; // 1: the normals point to the centre
    uint mesh[OPAL_WIDTH];
    uint id[OPAL_WIDTH];     // SHAPE_sphere << OPAL_SHAPE_SHIFT | index
} SphereBlock;
OPAL_SIZE_CHECK(SphereBlock, 224);

// A sphere's own axes as unit vectors of the scene, by its index, in scenes that need texture coordinates. They may be
// left-handed.
typedef struct {
    float axis[3][3];
} SphereFrame;
OPAL_SIZE_CHECK(SphereFrame, 36);

#ifdef __cplusplus
static_assert(SHAPE_COUNT <= OPAL_SHAPE_BITS); // one is left, so that no leaf is OPAL_NONE
}
#endif

#endif
