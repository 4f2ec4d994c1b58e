// The textures: a row and a record here, a file textures/NAME.cl, and functions in host/flatten/textures.cpp each.
#ifndef OPAL_TEXTURE_LIST_H
#define OPAL_TEXTURE_LIST_H

#include "shared/glue.h"

// TEXTURE(name)
#define OPAL_TEXTURES(TEXTURE) \
    TEXTURE(checkerboard) \
    TEXTURE(bitmap) \
    TEXTURE(mesh_attribute)

// How a bitmap goes on outside the unit square: again and again, mirrored there and back, by the texels of its sides.
enum { WRAP_repeat, WRAP_mirror, WRAP_clamp };

#define OPAL_TEXTURE_ENUM(name) TEXTURE_##name,
enum { OPAL_TEXTURES(OPAL_TEXTURE_ENUM) TEXTURE_COUNT };

#ifdef __cplusplus
namespace opal {
#endif

// The records of the kinds. All begin with the kind. to_uv: the map from a surface's texture coordinates (u, v, 1) to
// the texture's own.
typedef struct {
    uint kind;
    float to_uv[2][3];
    float color0[3], color1[3];
} texture_checkerboard_record;

typedef struct {
    uint kind;
    float to_uv[2][3];
    uint width, height;
    uint channels;        // of a texel: 1, grey, or 3
    uint first;           // its first value in the scene's texels: a byte if `decode` is not OPAL_NONE, else a float
    uint decode;          // the word of the texels at which 256 floats begin: what the bytes mean
    uint wrap;            // WRAP_*
    uint nearest;         // 1: the nearest texel; 0: bilinear interpolation
} texture_bitmap_record;

// Of one mesh. Triangle i has the words first + stride * i, modulo 2^32, of the attributes: three corners, or one.
typedef struct {
    uint kind;
    uint first, stride;
    uint channels;        // of a corner: 1, grey, or 3
    uint corners;         // 3, or 1: the same all over the triangle
    float scale;          // of all values
} texture_mesh_attribute_record;

#ifdef __cplusplus
}
#endif

#endif
