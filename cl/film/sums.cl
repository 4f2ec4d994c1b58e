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

// LANES consecutive pixels of a band, from its pixel `first` on. Only the lanes from `begin` to `end` are of the band;
// the others repeat one of its pixels and are not stored.
typedef struct {
    uints pixel;
    int first, begin, end;
    uint pixels; // of the band
    bool empty;  // nothing was added to the band yet, and its memory holds anything
} FilmPlace;

// lanes: how many are in the film
static FilmPlace film_place(int first, int lanes, uint pixels, uint empty) {
    FilmPlace at = {(uints)(0), first, max(-first, 0), min(min(lanes, LANES), (int)pixels - first), pixels, empty != 0};
    uint index[LANES];
    for (int lane = 0; lane < LANES; lane++) index[lane] = (uint)clamp(first + lane, 0, (int)pixels - 1);
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
    for (int lane = at.begin; lane < at.end; lane++) {
        float high = (float)hi[lane]; // what a double has beyond this float goes into the low part
        film[(ulong)plane * at.pixels + (uint)(at.first + lane)] = high;
        film[(ulong)low * at.pixels + (uint)(at.first + lane)] = (float)(lo[lane] + (hi[lane] - high));
    }
}
