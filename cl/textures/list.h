// The textures: one row, one list of parameters textures/NAME.h and one file textures/NAME.cl each. There are none yet.
#ifndef OPAL_TEXTURE_LIST_H
#define OPAL_TEXTURE_LIST_H

// TEXTURE(name)
#define OPAL_TEXTURES(TEXTURE)

#define OPAL_TEXTURE_ENUM(name) TEXTURE_##name,
enum { OPAL_TEXTURES(OPAL_TEXTURE_ENUM) TEXTURE_COUNT };

#endif
