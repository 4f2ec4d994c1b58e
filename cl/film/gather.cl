// gather: the kernel that adds a pass's samples to the film.
#include "cameras/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "film/sums.cl"
#include "film/filter.cl"
#include "scene.cl"
#include "shared/film.h"
#include "shared/types.h"

// The colour of sample s of each lane's pixel.
static v3 sample_color(global const float *samples, uints pixel, uint s, uint pass_samples) {
    global const float *sample = samples + OPAL_SAMPLE_FLOATS * s;
    uints word = pixel * (OPAL_SAMPLE_FLOATS * pass_samples);
    return v3_of(GATHER_WORD(real, sample, word), GATHER_WORD(real, (sample + 1), word),
                 GATHER_WORD(real, (sample + 2), word));
}

// Counts the samples that are neither finite nor empty, and records pixel and index of the first few.
static void note_invalid(global const float *samples, FilmPlace at, mask valid, uint s, uint pass_first,
                         uint pass_samples, volatile global uint *invalid) {
    int ok[LANES];
    STORE(to_ints(valid), ok);
    for (uint lane = 0; lane < LANES && at.first + lane < at.pixels; lane++) {
        uint pixel = at.first + lane;
        ulong sample = (ulong)pixel * pass_samples + s;
        if (ok[lane] || as_uint(samples[OPAL_SAMPLE_FLOATS * sample]) == OPAL_SAMPLE_EMPTY) continue;
        uint record = atomic_inc(invalid);
        if (record < OPAL_INVALID_RECORDS) {
            invalid[1 + 2 * record] = pixel;
            invalid[2 + 2 * record] = pass_first + s;
        }
    }
}

// Adds each pixel's own samples, for the box filter and for statistics.
static void gather_own(FilmPlace at, global const float *samples, global float *film, global uint *counts,
                       volatile global uint *invalid, uint pass_first, uint pass_samples) {
    Sum sums[3], squares[4];
    for (uint c = 0; c < 3; c++) sums[c] = film_load(film, at, FILM_SUM + c, FILM_SUM_LOW + c);
    for (uint c = 0; c < 4; c++) squares[c] = film_load(film, at, FILM_SQUARES + c, FILM_SQUARES_LOW + c);
    uints count = GATHER_WORD(uints, counts, at.pixel);
    for (uint s = 0; s < pass_samples; s++) {
        v3 c = sample_color(samples, at.pixel, s, pass_samples);
        mask valid = is_finite(c);
        if (ANY(!valid)) note_invalid(samples, at, valid, s, pass_first, pass_samples, invalid);
        sums[0] = sum_add(sums[0], c.x, valid);
        sums[1] = sum_add(sums[1], c.y, valid);
        sums[2] = sum_add(sums[2], c.z, valid);
        squares[0] = sum_add(squares[0], c.x * c.x, valid);
        squares[1] = sum_add(squares[1], c.y * c.y, valid);
        squares[2] = sum_add(squares[2], c.z * c.z, valid);
        squares[3] = sum_add(squares[3], square(luminance(c)), valid);
        count = count + uints_pick(valid, (uints)(1), (uints)(0));
    }
    for (uint c = 0; c < 3; c++) film_store(film, at, FILM_SUM + c, FILM_SUM_LOW + c, sums[c]);
    for (uint c = 0; c < 4; c++) film_store(film, at, FILM_SQUARES + c, FILM_SQUARES_LOW + c, squares[c]);
    uint count_of[LANES];
    STORE(count, count_of);
    for (uint lane = 0; lane < LANES && at.first + lane < at.pixels; lane++) counts[at.first + lane] = count_of[lane];
}

// Adds the samples of all pixels within the filter's radius, weighted by the filter.
static void gather_around(FilmPlace at, global const Settings *settings, global const float *samples,
                          global float *film, uint pass_first, uint pass_samples) {
    Scene scene = {settings}; // film_offset reads no table
    uint width = settings->film.width, height = settings->film.height;
    Sum sums[4];
    for (uint c = 0; c < 4; c++) sums[c] = film_load(film, at, FILM_WEIGHTED + c, FILM_WEIGHTED_LOW + c);
    int reach = (int)ceil(settings->filter_radius - 0.5f);
    uints x = at.pixel % width, y = at.pixel / width;
    for (uint s = 0; s < pass_samples; s++)
        for (int dy = -reach; dy <= reach; dy++)
            for (int dx = -reach; dx <= reach; dx++) {
                uints nx = x + (uint)dx, ny = y + (uint)dy; // below 0 wraps to far beyond the film
                mask inside = to_mask(nx < width) & to_mask(ny < height);
                uints pixel = uints_pick(inside, ny * width + nx, (uints)(0));
                uints of_image = (ny + settings->film.top) * settings->width + (nx + settings->film.left);
                v2 offset = film_offset(&scene, sampler_start(of_image, (uints)(pass_first + s), settings->seed));
                real w = filter_1d(settings, offset.x - R(0.5) + (real1)dx) *
                         filter_1d(settings, offset.y - R(0.5) + (real1)dy);
                v3 c = sample_color(samples, pixel, s, pass_samples);
                mask valid = inside & is_finite(c);
                sums[0] = sum_add(sums[0], w * c.x, valid);
                sums[1] = sum_add(sums[1], w * c.y, valid);
                sums[2] = sum_add(sums[2], w * c.z, valid);
                sums[3] = sum_add(sums[3], w, valid);
            }
    for (uint c = 0; c < 4; c++) film_store(film, at, FILM_WEIGHTED + c, FILM_WEIGHTED_LOW + c, sums[c]);
}

// Adds a pass to the film. A work-item adds LANES pixels, one sample after the other. invalid: how many samples are not
// finite, then pixel and index of the first OPAL_INVALID_RECORDS
kernel void gather(global const Settings *settings, global const float *samples, global float *film,
                   global uint *counts, volatile global uint *invalid, uint pass_first, uint pass_samples) {
    FilmPlace at;
    at.pixels = settings->film.width * settings->film.height;
    at.first = (uint)get_global_id(0) * LANES;
    if (at.first >= at.pixels) return;
    uint index[LANES];
    for (uint lane = 0; lane < LANES; lane++) index[lane] = min(at.first + lane, at.pixels - 1);
    at.pixel = LOAD(uints, index);
    gather_own(at, samples, film, counts, invalid, pass_first, pass_samples);
    if (OPAL_HAS_wide_filter) gather_around(at, settings, samples, film, pass_first, pass_samples);
}
