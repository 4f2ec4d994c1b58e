// dispatch: the texture of each lane, picked by kind (textures/NAME.cl for each row of textures/list.h).
#include "core/lanes.cl"
#include "scene.cl"
#include "shared/parameters.h"
#include "textures/*.cl"
#include "textures/list.h"

// The kinds that the kernel's scene has, a bit each in OPAL_TEXTURE_KINDS.
#define HAS_TEXTURE(name) ((OPAL_TEXTURE_KINDS >> TEXTURE_##name & 1) != 0)
#define HAS_ONE_TEXTURE_KIND ((OPAL_TEXTURE_KINDS & (OPAL_TEXTURE_KINDS - 1)) == 0)

// The lanes of that kind.
static mask texture_lanes(const Scene *scene, uints at, uint wanted) {
    if (HAS_ONE_TEXTURE_KIND) return ALL_LANES;
    return to_mask(GATHER_WORD(uints, scene->textures, at) == wanted);
}

// The factor that the textures `at` give a parameter at `point`: 1 in lanes that are not active or have no texture
// (OPAL_UNTEXTURED).
static CALLED v3 texture_color(const Scene *scene, uints at, TexturePoint point, mask active) {
    v3 factor = v3_all((real)(1));
    mask textured = active & to_mask(at != OPAL_UNTEXTURED);
    at = uints_pick(textured, at, (uints)(0));
#define TEXTURE_COLOR(name) \
    if (HAS_TEXTURE(name)) { \
        mask m = textured & texture_lanes(scene, at, TEXTURE_##name); \
        if (ANY(m)) factor = v3_pick(m, texture_##name##_color(scene, at, point, m), factor); \
    }
    OPAL_TEXTURES(TEXTURE_COLOR)
    return factor;
}

// The derivatives over u and v of that factor's luminance: 0 in lanes that are not active or have no bitmap.
static v2 texture_gradient(const Scene *scene, uints at, TexturePoint point, mask active) {
    v2 gradient = v2_of((real)(0), (real)(0));
    mask textured = active & to_mask(at != OPAL_UNTEXTURED);
    at = uints_pick(textured, at, (uints)(0));
    if (!HAS_TEXTURE(bitmap)) return gradient;
    mask bitmap = textured & texture_lanes(scene, at, TEXTURE_bitmap);
    if (!ANY(bitmap)) return gradient;
    v2 own = texture_bitmap_gradient(scene, at, point, bitmap);
    return v2_of(bitmap ? own.x : gradient.x, bitmap ? own.y : gradient.y);
}
