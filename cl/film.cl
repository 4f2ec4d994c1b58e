// film: sums of the finished samples of each pixel.
//
// A pass leaves sample s of pixel p in slots[(p * pass_samples + s) * 3 ...]. It is added here in the order of the samples, into
// sums of two floats each (Knuth's two-sum), so that neither the cut into passes nor a million samples change a bit too many.
// A slot that holds SLOT_EMPTY was not rendered (an interrupted pass); one that is not finite is counted and left out.
#define SLOT_EMPTY 0x7fc0de1au
#define INVALID_RECORDS 8

// Planes of the film, one float a pixel each: sums and their low parts.
#define FILM_SUM 0         // of r, g, b; low parts 3 further
#define FILM_SQUARES 6     // of r^2, g^2, b^2, luminance^2; low parts 4 further
#define FILM_WEIGHTED 14   // wide filters: sum of w r, w g, w b, w; low parts 4 further
#define FILM_PLANES 22

typedef struct { real hi, lo; } Sum;

static Sum sum_add(Sum s, real x, mask valid) {
#pragma OPENCL FP_CONTRACT OFF
    x = valid ? x : (real)(0);
    real hi = s.hi + x;
    real part = hi - s.hi;
    real lo = s.lo + ((s.hi - (hi - part)) + (x - part));
    Sum r;
    r.hi = hi + lo; // again, or lo grows until it rounds as a plain sum does
    r.lo = lo - (r.hi - hi);
    return r;
}

// The planes of LANES pixels from `first` on; lanes past the end of the image repeat its last pixel and are not stored.
typedef struct { uints pixel; uint first, pixels; } FilmPlace;

static Sum film_load(global const float *film, FilmPlace at, uint plane, uint low) {
    global const float *hi = film + (ulong)plane * at.pixels, *lo = film + (ulong)(plane + low) * at.pixels;
    Sum s = {GATHER(real, hi, at.pixel, ), GATHER(real, lo, at.pixel, )};
    return s;
}

static void film_store(global float *film, FilmPlace at, uint plane, uint low, Sum s) {
    real1 hi[LANES], lo[LANES];
    STORE(s.hi, hi);
    STORE(s.lo, lo);
    for (uint lane = 0; lane < LANES && at.first + lane < at.pixels; lane++) {
        float high = (float)hi[lane]; // what doubles have beyond it goes into the low part
        film[(ulong)plane * at.pixels + at.first + lane] = high;
        film[(ulong)(plane + low) * at.pixels + at.first + lane] = (float)(lo[lane] + (hi[lane] - high));
    }
}

#define float_bits(x) CAT(as_, WIDE(uint))(CAT(convert_, WIDE(float))(x))

// Told by exponent bits, which no compiler option voids.
static mask is_finite(v3 c) {
    uints all = (uints)(0x7f800000u);
    uints x = float_bits(c.x), y = float_bits(c.y), z = float_bits(c.z);
    return to_mask((x & all) != all) & to_mask((y & all) != all) & to_mask((z & all) != all);
}
