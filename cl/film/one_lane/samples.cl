// one_lane/samples: where a pass leaves its samples until they are added to the film: sample after sample, r, g and b
// together. The functions are those of many_lanes/samples.cl.
#include "core/lanes.cl"
#include "shared/film.h"

#define SAMPLE_WORD(pixel, sample, pass_samples) (((pixel) * (pass_samples) + (sample)) * OPAL_SAMPLE_FLOATS)
#define SAMPLE_CHANNEL(c, pass_samples) (c)

static uint load_colors(global const float *samples, uint pixel, uint sample, uint pass_samples, v3 *colors) {
    uint word = SAMPLE_WORD(pixel, sample, pass_samples);
    *colors = v3_of(samples[word], samples[word + 1], samples[word + 2]);
    return 1;
}

// Work-items of one lane run by the thousand, which hides the latency of memory.
static void fetch_next(global const float *samples, uint pixel, uint s, uint pass_samples) {}
