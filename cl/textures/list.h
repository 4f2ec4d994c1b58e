// The textures: a row and a record here, one file textures/NAME.cl and one file host/flatten/texture_NAME.cpp each.
#ifndef OPAL_TEXTURE_LIST_H
#define OPAL_TEXTURE_LIST_H

#include "shared/glue.h"

// TEXTURE(name)
#define OPAL_TEXTURES(TEXTURE) \
    TEXTURE(checkerboard)

#define OPAL_TEXTURE_ENUM(name) TEXTURE_##name,
enum { OPAL_TEXTURES(OPAL_TEXTURE_ENUM) TEXTURE_COUNT };

#ifdef __cplusplus
namespace opal {
#endif

// The records of the kinds. All begin with the kind, and with the map from a surface's texture coordinates (u, v, 1) to
// the texture's own.
typedef struct {
    uint kind;
    float to_uv[2][3];
    float color0[3], color1[3];
} texture_checkerboard_record;

#ifdef __cplusplus
}
#endif

#endif
