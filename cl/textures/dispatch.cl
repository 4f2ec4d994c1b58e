// dispatch: the texture of each lane, picked by kind (textures/NAME.cl for each row of textures/list.h).
#include "core/lanes.cl"
#include "scene.cl"
#include "shared/parameters.h"
#include "textures/*.cl"
#include "textures/list.h"

// The factor that the textures `at` give a parameter at `point`: 1 in lanes that are not active or have no texture
// (OPAL_UNTEXTURED).
static v3 texture_color(const Scene *scene, uints at, TexturePoint point, mask active) {
    v3 factor = v3_all((real)(1));
    mask textured = active & to_mask(at != OPAL_UNTEXTURED);
    at = uints_pick(textured, at, (uints)(0));
    uints kind = GATHER_WORD(uints, scene->textures, at);
#define TEXTURE_COLOR(name) { \
        mask m = textured & to_mask(kind == TEXTURE_##name); \
        if (ANY(m)) factor = v3_pick(m, texture_##name##_color(scene, at, point, m), factor); \
    }
    OPAL_TEXTURES(TEXTURE_COLOR)
    return factor;
}
