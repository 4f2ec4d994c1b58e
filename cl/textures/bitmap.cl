// bitmap: the texels of an image, at the middles of equal cells of the unit square; v = 0 is the image's top.
//   <texture name="reflectance" type="bitmap"> <string name="filename" value="wood.png"/> </texture>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rows.cl"
#include "scene.cl"
#include "shared/types.h"
#include "textures/interface.cl"
#include "textures/list.h"

// The lanes whose bitmaps, of that form, are `what`, others being `other`; a constant where the kernel's are all alike.
static mask bitmap_is(uints form, uint what, uint other) {
    if ((OPAL_BITMAP_FORMS & what) == 0) return NO_LANES;
    if ((OPAL_BITMAP_FORMS & other) == 0) return ALL_LANES;
    return to_mask((form & what) != 0u);
}

typedef struct {
    uints width, height, first;
    mask repeats, mirrors, nearest, grey;
    mask bytes, encoded, floats; // what the values are; `bytes` and `floats` in the active lanes alone
    v3 to_u, to_v;               // the map of texture coordinates, where some bitmap has one
} Bitmap;

static Bitmap bitmap_at(const Scene *scene, uints at, mask active) {
    global const texture_bitmap_record *record = (global const texture_bitmap_record *)scene->textures;
    FourWords words = four_words(&record->kind, at);
    Bitmap b;
    b.width = words.b;
    b.height = words.c;
    b.first = words.d;
    uints form = GATHER_WORD(uints, &record->form, at);
    b.repeats = bitmap_is(form, BITMAP_REPEAT, BITMAP_MIRROR | BITMAP_CLAMP);
    b.mirrors = bitmap_is(form, BITMAP_MIRROR, BITMAP_REPEAT | BITMAP_CLAMP);
    b.nearest = bitmap_is(form, BITMAP_NEAREST, BITMAP_BILINEAR);
    b.grey = bitmap_is(form, BITMAP_GREY, BITMAP_RGB);
    b.encoded = bitmap_is(form, BITMAP_ENCODED, BITMAP_BYTES | BITMAP_FLOATS);
    b.bytes = active & bitmap_is(form, BITMAP_ENCODED | BITMAP_BYTES, BITMAP_FLOATS);
    b.floats = active & bitmap_is(form, BITMAP_FLOATS, BITMAP_ENCODED | BITMAP_BYTES);
    if (OPAL_BITMAP_FORMS & BITMAP_MAPPED) {
        b.to_u = v3_at(record->to_uv[0], at);
        b.to_v = v3_at(record->to_uv[1], at);
    } else {
        b.to_u = v3_of((real)(1), (real)(0), (real)(0));
        b.to_v = v3_of((real)(0), (real)(1), (real)(0));
    }
    return b;
}

// The bitmap's own coordinates.
static v2 bitmap_uv(Bitmap b, v2 uv) {
    if (!(OPAL_BITMAP_FORMS & BITMAP_MAPPED)) return uv;
    return texture_uv(b.to_u, b.to_v, uv);
}

// Two neighbouring texels along one axis: the index of the first one, the share of the second, and how fast that grows
// with the coordinate, per texel: 1, -1 in a mirrored image, 0 where the texel is the same.
typedef struct {
    uints first;
    real share, slope;
} TexelPair;

static TexelPair texels_at(real x, uints size, Bitmap b) {
    real clamped = real_min(real_max(x, (real)(-1)), (real)(2));
    real within = b.repeats ? x - floor(x) : b.mirrors ? x - 2 * floor(x / 2) : clamped;
    within = within <= 2 ? within : (real)(0); // of NaN and infinity
    ints n = as_signed(size), last = n - 1;
    real position = within * to_real(n) - (b.nearest ? (real)(0) : (real)(R(0.5)));
    real below = floor(position), share = position - below;
    ints i = to_ints(below);
    mask back = b.mirrors & to_mask(i > last); // a mirrored pair begins with the texel that comes second
    i = to_ints(back) ? last + last - i + (to_ints(b.nearest) ? (ints)(1) : (ints)(0)) : i;
    share = back ? 1 - share : share;
    ints repeated = i < 0 ? last : i > last ? (ints)(0) : i; // n and more: where rounding led to 1
    i = to_ints(b.repeats) ? repeated : i;
    mask alone = (!b.repeats & to_mask(i < 0)) | b.nearest; // before the first one there is the first one again
    i = i < 0 ? 0 : i;
    TexelPair pair = {as_unsigned(i < last ? i : last), alone ? (real)(0) : share,
                      alone ? (real)(0) : back ? (real)(-1) : (real)(1)};
    return pair;
}

// The row below.
static uints row_after(uints y, Bitmap b) {
    mask last = to_mask(y + 1u == b.height);
    return uints_pick(last, uints_pick(b.repeats, (uints)(0), y), y + 1u);
}

// The number that a byte means: b / 255, or what sRGB's curve encodes by it. From 11 on, where the curve is
// ((x + 0.055) / 1.055)^2.4 of x = b / 255, a polynomial in x - 0.5 that is 1 for 255 and has the least error of all
// bytes together, 2e-7; in single precision 4e-7.
static real byte_value(uints byte, Bitmap b) {
    if (!(OPAL_BITMAP_FORMS & BITMAP_ENCODED)) return to_real(as_signed(byte)) * (1 / R(255.0));
    real x = to_real(as_signed(byte)), z = x * (1 / R(255.0)) - R(0.5);
    real p = mul_add(z, (real)(R(0.10021387)), (real)(R(-0.0880927458)));
    p = mul_add(z, mul_add(z, p, (real)(R(0.0165460386))), (real)(R(-0.020416894)));
    p = mul_add(z, mul_add(z, p, (real)(R(0.0451302989))), (real)(R(-0.0770465692)));
    p = mul_add(z, mul_add(z, p, (real)(R(0.280400666))), (real)(R(1.16744069)));
    p = mul_add(z, mul_add(z, p, (real)(R(0.925584018))), (real)(R(0.214040955)));
    real linear = x * (b.encoded ? (real)(1 / (R(255.0) * R(12.92))) : (real)(1 / R(255.0)));
    return (b.encoded & (x > R(10.5))) ? real_min(p, (real)(1)) : linear;
}

static v3 byte_color(uints bytes, Bitmap b) {
    uints red = bytes & 255u;
    uints green = uints_pick(b.grey, red, bytes >> 8 & 255u), blue = uints_pick(b.grey, red, bytes >> 16 & 255u);
    return v3_of(byte_value(red, b), byte_value(green, b), byte_value(blue, b));
}

typedef struct {
    v3 left, right;
} BitmapTexels;

// Texel x of row y, and its right neighbour.
static BitmapTexels bitmap_texels(const Scene *scene, Bitmap b, uints x, uints y) {
    uints at = b.first + (y * (b.width + 1u) + x) * uints_pick(b.grey, (uints)(1), (uints)(3));
    BitmapTexels texels = {v3_all((real)(0)), v3_all((real)(0))};
    if (ANY(b.bytes)) {
        EightBytes bytes = eight_bytes(scene->texels, uints_pick(b.bytes, at, (uints)(0)));
        uints right = uints_pick(b.grey, bytes.low >> 8, bytes.low >> 24 | bytes.high << 8);
        texels.left = byte_color(bytes.low, b);
        texels.right = byte_color(right, b);
    }
    if (ANY(b.floats)) {
        uints first = uints_pick(b.floats, at, (uints)(0));
        FourWords low = four_words(scene->texels, first), high = four_words(scene->texels, first + 2u);
        v3 left = v3_of(reals_of_words(low.a), reals_of_words(low.b), reals_of_words(low.c));
        v3 right = v3_of(reals_of_words(low.d), reals_of_words(high.c), reals_of_words(high.d));
        left = v3_pick(b.grey, v3_all(left.x), left);
        right = v3_pick(b.grey, v3_all(reals_of_words(low.b)), right);
        texels.left = v3_pick(b.floats, left, texels.left);
        texels.right = v3_pick(b.floats, right, texels.right);
    }
    return texels;
}

static v3 mixed(v3 a, v3 b, real share) { // a + share (b - a) would lose a dim texel beside a bright one
    return v3_mad(b, share, v3_scale(a, 1 - share));
}

static v3 texture_bitmap_color(const Scene *scene, uints at, TexturePoint point, mask active) {
    Bitmap b = bitmap_at(scene, at, active);
    v2 uv = bitmap_uv(b, point.uv);
    TexelPair x = texels_at(uv.x, b.width, b), y = texels_at(uv.y, b.height, b);
    BitmapTexels upper = bitmap_texels(scene, b, x.first, y.first);
    if (!(OPAL_BITMAP_FORMS & BITMAP_BILINEAR)) return upper.left;
    BitmapTexels lower = bitmap_texels(scene, b, x.first, row_after(y.first, b));
    return mixed(mixed(upper.left, upper.right, x.share), mixed(lower.left, lower.right, x.share), y.share);
}

// The derivatives over u and v of the luminance, which is bilinear between texels: they jump from cell to cell. They
// are 0 of the nearest texel.
static v2 texture_bitmap_gradient(const Scene *scene, uints at, TexturePoint point, mask active) {
    Bitmap b = bitmap_at(scene, at, active);
    v2 uv = bitmap_uv(b, point.uv);
    TexelPair x = texels_at(uv.x, b.width, b), y = texels_at(uv.y, b.height, b);
    BitmapTexels upper = bitmap_texels(scene, b, x.first, y.first);
    BitmapTexels lower = bitmap_texels(scene, b, x.first, row_after(y.first, b));
    real value[2][2] = {{luminance(upper.left), luminance(upper.right)},
                        {luminance(lower.left), luminance(lower.right)}};
    real along_x = (1 - y.share) * (value[0][1] - value[0][0]) + y.share * (value[1][1] - value[1][0]);
    real along_y = (1 - x.share) * (value[1][0] - value[0][0]) + x.share * (value[1][1] - value[0][1]);
    along_x = along_x * x.slope * to_real(b.width);
    along_y = along_y * y.slope * to_real(b.height);
    // The chain rule.
    return v2_of(along_x * b.to_u.x + along_y * b.to_v.x, along_x * b.to_u.y + along_y * b.to_v.y);
}
