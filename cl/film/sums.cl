// sums: the sums over the finished samples of each pixel, in pairs of floats.
//
// A pass leaves sample s of pixel p in samples[(p * pass_samples + s) * OPAL_SAMPLE_FLOATS ...]. Samples are added in
// their order, into sums of two floats (Knuth's two-sum), so that neither the cut into passes nor a million samples
// change a bit. Samples that are OPAL_SAMPLE_EMPTY are skipped; those that are not finite are counted and left out.
#include "core/lanes.cl"
#include "shared/types.h"

typedef struct { real hi, lo; } Sum;

// Adds x in the lanes of `valid`.
static Sum sum_add(Sum s, real x, mask valid) {
#pragma OPENCL FP_CONTRACT OFF
    x = valid ? x : (real)(0);
    real hi = s.hi + x;
    real part = hi - s.hi;
    real lo = s.lo + ((s.hi - (hi - part)) + (x - part));
    Sum r;
    r.hi = hi + lo; // normalised, or lo grows until it rounds as a plain sum does
    r.lo = lo - (r.hi - hi);
    return r;
}

// LANES pixels of a band from its pixel `first` on. Lanes beyond the band's last pixel repeat it and are not stored.
typedef struct {
    uints pixel;
    uint first, pixels; // `pixels`: of the band
    bool empty;         // nothing was added to the band yet, and its memory holds anything
} FilmPlace;

static FilmPlace film_place(uint pixels, uint empty) {
    FilmPlace at = {(uints)(0), (uint)get_global_id(0) * LANES, pixels, empty != 0};
    uint index[LANES];
    for (uint lane = 0; lane < LANES; lane++) index[lane] = min(at.first + lane, pixels - 1);
    at.pixel = LOAD(uints, index);
    return at;
}

// The sum in the planes `plane` and `low` (FILM_*).
static Sum film_load(global const float *film, FilmPlace at, uint plane, uint low) {
    Sum none = {(real)(0), (real)(0)};
    if (at.empty) return none;
    global const float *hi = film + (ulong)plane * at.pixels, *lo = film + (ulong)low * at.pixels;
    Sum s = {GATHER_WORD(real, hi, at.pixel), GATHER_WORD(real, lo, at.pixel)};
    return s;
}

static void film_store(global float *film, FilmPlace at, uint plane, uint low, Sum s) {
    real1 hi[LANES], lo[LANES];
    STORE(s.hi, hi);
    STORE(s.lo, lo);
    for (uint lane = 0; lane < LANES && at.first + lane < at.pixels; lane++) {
        float high = (float)hi[lane]; // what a double has beyond this float goes into the low part
        film[(ulong)plane * at.pixels + at.first + lane] = high;
        film[(ulong)low * at.pixels + at.first + lane] = (float)(lo[lane] + (hi[lane] - high));
    }
}
