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

// What bitmaps may be: one bit of each line. A kernel knows the bits that its scene's bitmaps have (OPAL_BITMAP_FORMS),
// and asks a lane's record only where these differ.
enum {
    BITMAP_REPEAT = 1, BITMAP_MIRROR = 2, BITMAP_CLAMP = 4, // WRAP_*
    BITMAP_BILINEAR = 8, BITMAP_NEAREST = 16,
    BITMAP_GREY = 32, BITMAP_RGB = 64,                      // channels of a texel
    BITMAP_ENCODED = 128, BITMAP_BYTES = 256, BITMAP_FLOATS = 512, // values: bytes of sRGB's curve, of 0 to 1; floats
    BITMAP_UNMAPPED = 1024, BITMAP_MAPPED = 2048,           // whether to_uv moves texture coordinates
    BITMAP_FORMS = 4095
};

// The records of the kinds. All begin with the kind. to_uv: the map from a surface's texture coordinates (u, v, 1) to
// the texture's own.
typedef struct {
    uint kind;
    float to_uv[2][3];
    float color0[3], color1[3];
} texture_checkerboard_record;

// A row of texels ends with one more: the first one again where the bitmap repeats, else the last. So a texel and its
// right neighbour lie side by side.
typedef struct {
    uint kind;
    uint width, height;
    uint first;           // its first value in the scene's texels, in bytes if these are bytes, else in floats
    float to_uv[2][3];
    uint form;            // BITMAP_*
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
