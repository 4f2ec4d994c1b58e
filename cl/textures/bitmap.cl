// bitmap: the texels of an image, at the middles of equal cells of the unit square; v = 0 is the image's top.
//   <texture name="reflectance" type="bitmap"> <string name="filename" value="wood.png"/> </texture>
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shared/types.h"
#include "textures/interface.cl"
#include "textures/list.h"

// The texel i of n along one axis, where i is within one period of [0, n): its index within the image.
static uints wrapped_texel(ints i, ints n, uints wrap) {
    ints repeated = i < 0 ? i + n : i >= n ? i - n : i;
    ints mirrored = i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i;
    ints wrapped = wrap == (uint)WRAP_repeat ? repeated : wrap == (uint)WRAP_mirror ? mirrored : i;
    wrapped = wrapped < 0 ? 0 : wrapped;
    return as_unsigned(wrapped < n ? wrapped : n - 1);
}

// Two neighbouring texels along one axis, and the share of the second one.
typedef struct {
    uints texel[2];
    real share;
} TexelPair;

static TexelPair texels_at(real x, uints size, uints wrap, mask nearest) {
    mask repeats = to_mask(wrap == (uint)WRAP_repeat), mirrors = to_mask(wrap == (uint)WRAP_mirror);
    real clamped = real_min(real_max(x, (real)(-1)), (real)(2));
    real within = repeats ? x - floor(x) : mirrors ? x - 2 * floor(x / 2) : clamped;
    within = (within >= -1 & within <= 2) ? within : (real)(0); // of NaN and infinity
    real position = within * to_real(size) - (nearest ? (real)(0) : (real)(R(0.5)));
    real below = floor(position);
    ints first = to_ints(below), n = as_signed(size);
    TexelPair pair = {{wrapped_texel(first, n, wrap), wrapped_texel(first + 1, n, wrap)},
                      nearest ? (real)(0) : position - below};
    return pair;
}

typedef struct {
    uints width, channels, first, decode;
    mask bytes, floats; // the active lanes whose values are bytes, or floats
} Bitmap;

static v3 bitmap_texel(const Scene *scene, Bitmap b, uints x, uints y) {
    global const uchar *bytes = (global const uchar *)scene->texels;
    global const float *floats = (global const float *)scene->texels;
    uints red = b.first + (y * b.width + x) * b.channels;
    uints green = uints_pick(to_mask(b.channels == 1u), red, red + 1u), blue = green + (green - red);
    uints at[3] = {red, green, blue};
    real value[3] = {0, 0, 0};
    for (int c = 0; c < 3; c++) {
        if (ANY(b.bytes)) {
            uints byte = GATHER_WORD(uints, bytes, uints_pick(b.bytes, at[c], (uints)(0)));
            value[c] = GATHER_WORD(real, floats, uints_pick(b.bytes, b.decode + byte, (uints)(0)));
        }
        if (ANY(b.floats)) {
            real read = GATHER_WORD(real, floats, uints_pick(b.floats, at[c], (uints)(0)));
            value[c] = b.floats ? read : value[c];
        }
    }
    return v3_of(value[0], value[1], value[2]);
}

static v3 mixed(v3 a, v3 b, real share) { // a + share (b - a) would lose a dim texel beside a bright one
    return v3_mad(b, share, v3_scale(a, 1 - share));
}

static v3 texture_bitmap_color(const Scene *scene, uints at, TexturePoint point, mask active) {
    global const texture_bitmap_record *record = (global const texture_bitmap_record *)scene->textures;
    v2 uv = texture_uv(record->to_uv, at, point.uv);
    uints wrap = GATHER_WORD(uints, &record->wrap, at);
    mask nearest = to_mask(GATHER_WORD(uints, &record->nearest, at) != 0u);
    Bitmap b;
    b.width = GATHER_WORD(uints, &record->width, at);
    b.channels = GATHER_WORD(uints, &record->channels, at);
    b.first = GATHER_WORD(uints, &record->first, at);
    b.decode = GATHER_WORD(uints, &record->decode, at);
    b.bytes = active & to_mask(b.decode != OPAL_NONE);
    b.floats = active & to_mask(b.decode == OPAL_NONE);
    TexelPair x = texels_at(uv.x, b.width, wrap, nearest);
    TexelPair y = texels_at(uv.y, GATHER_WORD(uints, &record->height, at), wrap, nearest);
    v3 top = mixed(bitmap_texel(scene, b, x.texel[0], y.texel[0]), bitmap_texel(scene, b, x.texel[1], y.texel[0]),
                   x.share);
    v3 bottom = mixed(bitmap_texel(scene, b, x.texel[0], y.texel[1]), bitmap_texel(scene, b, x.texel[1], y.texel[1]),
                      x.share);
    return mixed(top, bottom, y.share);
}
