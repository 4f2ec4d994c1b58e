// many_lanes/samples: where a pass leaves its samples until they are added to the film: of each pixel the r of all
// samples, then g, then b. So consecutive samples of a pixel are vectors.
//   channel c of a pixel's sample is the float
//   SAMPLE_WORD(pixel, sample, pass_samples) + SAMPLE_CHANNEL(c, pass_samples)
//   uint load_colors(samples, pixel, sample, pass_samples, colors)
//       reads the colours of each lane's pixel, of samples from `sample` on, into colors[0], colors[1] ...
//       (LANES at the most). Returns how many.
//   void fetch_next(samples, pixel, s, pass_samples)
//       prefetches what the work-item reads that comes after the one of `pixel`, its first; a part of it each s
#include "core/lanes.cl"
#include "core/many_lanes/eight_wide.cl"
#include "shared/film.h"

#define SAMPLE_WORD(pixel, sample, pass_samples) ((pixel) * (OPAL_SAMPLE_FLOATS * (pass_samples)) + (sample))
#define SAMPLE_CHANNEL(c, pass_samples) ((c) * (pass_samples))

// Exchanges rows and columns. Each step weaves rows i and i + LANES / 2, which rotates the bits of (row, column) by one
// place; log2(LANES) steps exchange the two.
static void transpose(real *rows) {
#pragma unroll
    for (uint n = 1; n < LANES; n *= 2) {
        real woven[LANES];
#pragma unroll
        for (uint i = 0; i < LANES / 2; i++) {
            real a = rows[i], b = rows[i + LANES / 2];
            woven[2 * i].even = a.lo;
            woven[2 * i].odd = b.lo;
            woven[2 * i + 1].even = a.hi;
            woven[2 * i + 1].odd = b.hi;
        }
#pragma unroll
        for (uint i = 0; i < LANES; i++) rows[i] = woven[i];
    }
}

static uint load_colors(global const float *samples, uints pixel, uint sample, uint pass_samples, v3 *colors) {
    uints word = SAMPLE_WORD(pixel, sample, pass_samples);
    uint step = SAMPLE_CHANNEL(1, pass_samples);
    if (pass_samples - sample < LANES) {
        *colors = v3_of(GATHER_WORD(real, samples, word), GATHER_WORD(real, (samples + step), word),
                        GATHER_WORD(real, (samples + 2 * step), word));
        return 1;
    }
    uint first[LANES];
    STORE(word, first);
    real rows[OPAL_SAMPLE_FLOATS][LANES];
    for (uint c = 0; c < OPAL_SAMPLE_FLOATS; c++) {
        for (uint lane = 0; lane < LANES; lane++)
            rows[c][lane] = to_real(LOAD(WIDE(float), samples + c * step + first[lane]));
        transpose(rows[c]);
    }
    for (uint k = 0; k < LANES; k++) colors[k] = v3_of(rows[0][k], rows[1][k], rows[2][k]);
    return LANES;
}

static void fetch_next(global const float *samples, uint pixel, uint s, uint pass_samples) {
    global const char *next = (global const char *)(samples + SAMPLE_WORD(pixel + LANES, 0u, pass_samples));
    enum { BYTES = 4 * OPAL_SAMPLE_FLOATS * LANES }; // of one sample of each pixel
    for (uint byte = 0; byte < BYTES; byte += CACHE_LINE) FETCH(next + s * BYTES + byte);
}
