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
    uints width, height, channels, first, decode, wrap;
    mask nearest;
    mask bytes, floats; // the active lanes whose values are bytes, or floats
    v3 to_u, to_v;      // the map of texture coordinates
} Bitmap;

// The record of all active lanes, where that is one, is read once.
static Bitmap bitmap_at(const Scene *scene, uints at, mask active) {
    global const texture_bitmap_record *record = (global const texture_bitmap_record *)scene->textures;
    Bitmap b;
    uints nearest;
#if LANES > 1
    uint one = MAX_OF_LANES(uints_pick(active, at, (uints)(0)));
    if (!ANY(active & to_mask(at != one))) {
        record = (global const texture_bitmap_record *)(scene->textures + one);
        b.width = record->width;
        b.height = record->height;
        b.channels = record->channels;
        b.first = record->first;
        b.decode = record->decode;
        b.wrap = record->wrap;
        nearest = record->nearest;
        b.to_u = v3_of(record->to_uv[0][0], record->to_uv[0][1], record->to_uv[0][2]);
        b.to_v = v3_of(record->to_uv[1][0], record->to_uv[1][1], record->to_uv[1][2]);
    } else
#endif
    {
        b.width = GATHER_WORD(uints, &record->width, at);
        b.height = GATHER_WORD(uints, &record->height, at);
        b.channels = GATHER_WORD(uints, &record->channels, at);
        b.first = GATHER_WORD(uints, &record->first, at);
        b.decode = GATHER_WORD(uints, &record->decode, at);
        b.wrap = GATHER_WORD(uints, &record->wrap, at);
        nearest = GATHER_WORD(uints, &record->nearest, at);
        b.to_u = texture_words(record->to_uv[0], at);
        b.to_v = texture_words(record->to_uv[1], at);
    }
    b.nearest = to_mask(nearest != 0u);
    b.bytes = active & to_mask(b.decode != OPAL_NONE);
    b.floats = active & to_mask(b.decode == OPAL_NONE);
    return b;
}

// The texel of up to three bytes that begins at byte `at`, its first byte lowest, from the words that hold its ends.
static uints bitmap_bytes(const Scene *scene, Bitmap b, uints at) {
    at = uints_pick(b.bytes, at, (uints)(0));
    uints low = GATHER_WORD(uints, scene->texels, at >> 2);
    uints high = GATHER_WORD(uints, scene->texels, (at + uints_pick(b.bytes, b.channels - 1u, (uints)(0))) >> 2);
    uints shift = (at & 3u) * 8u;
    return (low >> shift) | ((high << 1) << (31u - shift)); // at shift 0 a single shift would be by all 32 bits
}

static v3 bitmap_texel(const Scene *scene, Bitmap b, uints x, uints y) {
    global const float *floats = (global const float *)scene->texels;
    uints at = b.first + (y * b.width + x) * b.channels;
    mask grey = to_mask(b.channels == 1u);
    v3 value = v3_all((real)(0));
    if (ANY(b.bytes)) {
        uints bytes = bitmap_bytes(scene, b, at);
        uints red = bytes & 255u, green = uints_pick(grey, red, bytes >> 8 & 255u);
        uints blue = uints_pick(grey, red, bytes >> 16 & 255u);
        uints decode = uints_pick(b.bytes, b.decode, (uints)(0));
        value = v3_of(GATHER_WORD(real, floats, decode + red), GATHER_WORD(real, floats, decode + green),
                      GATHER_WORD(real, floats, decode + blue));
    }
    if (ANY(b.floats)) {
        uints step = uints_pick(grey, (uints)(0), (uints)(1));
        uints red = uints_pick(b.floats, at, (uints)(0));
        v3 read = v3_of(GATHER_WORD(real, floats, red), GATHER_WORD(real, floats, red + step),
                        GATHER_WORD(real, floats, red + step + step));
        value = v3_pick(b.floats, read, value);
    }
    return value;
}

static v3 mixed(v3 a, v3 b, real share) { // a + share (b - a) would lose a dim texel beside a bright one
    return v3_mad(b, share, v3_scale(a, 1 - share));
}

static v3 texture_bitmap_color(const Scene *scene, uints at, TexturePoint point, mask active) {
    Bitmap b = bitmap_at(scene, at, active);
    v2 uv = point.uv;
    real u = b.to_u.x * uv.x + b.to_u.y * uv.y + b.to_u.z, v = b.to_v.x * uv.x + b.to_v.y * uv.y + b.to_v.z;
    TexelPair x = texels_at(u, b.width, b.wrap, b.nearest), y = texels_at(v, b.height, b.wrap, b.nearest);
    v3 top = mixed(bitmap_texel(scene, b, x.texel[0], y.texel[0]), bitmap_texel(scene, b, x.texel[1], y.texel[0]),
                   x.share);
    v3 bottom = mixed(bitmap_texel(scene, b, x.texel[0], y.texel[1]), bitmap_texel(scene, b, x.texel[1], y.texel[1]),
                      x.share);
    return mixed(top, bottom, y.share);
}

// The derivatives over u and v of the luminance, which is bilinear between texels: they jump from cell to cell. They
// are 0 of the nearest texel.
static v2 texture_bitmap_gradient(const Scene *scene, uints at, TexturePoint point, mask active) {
    Bitmap b = bitmap_at(scene, at, active);
    v2 uv = point.uv;
    real u = b.to_u.x * uv.x + b.to_u.y * uv.y + b.to_u.z, v = b.to_v.x * uv.x + b.to_v.y * uv.y + b.to_v.z;
    TexelPair x = texels_at(u, b.width, b.wrap, b.nearest), y = texels_at(v, b.height, b.wrap, b.nearest);
    real value[2][2];
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) value[j][i] = luminance(bitmap_texel(scene, b, x.texel[i], y.texel[j]));
    real along_x = (1 - y.share) * (value[0][1] - value[0][0]) + y.share * (value[1][1] - value[1][0]);
    real along_y = (1 - x.share) * (value[1][0] - value[0][0]) + x.share * (value[1][1] - value[0][1]);
    along_x = b.nearest ? (real)(0) : along_x * to_real(b.width);
    along_y = b.nearest ? (real)(0) : along_y * to_real(b.height);
    // The chain rule.
    return v2_of(along_x * b.to_u.x + along_y * b.to_v.x, along_x * b.to_u.y + along_y * b.to_v.y);
}
