// gather: the kernels that add a pass's samples to the film, whose memory is cut into bands of consecutive pixels. A
// work-item adds LANES pixels of a band, one sample after the other; those past the band's end do nothing.
//   band_first   the band's first pixel in the film
//   empty        not 0: nothing was added to the band yet, and its memory holds anything
#include "cameras/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "film/filter.cl"
#include "film/sums.cl"
#include "scene.cl"
#include "shared/film.h"
#include "shared/types.h"
#if LANES == 1
#include "film/one_lane/samples.cl"
#else
#include "film/many_lanes/samples.cl"
#endif

// The colour of sample s of each lane's pixel.
static v3 sample_color(global const float *samples, uints pixel, uint s, uint pass_samples) {
    uints word = SAMPLE_WORD(pixel, s, pass_samples);
    uint step = SAMPLE_CHANNEL(1, pass_samples);
    return v3_of(GATHER_WORD(real, samples, word), GATHER_WORD(real, (samples + step), word),
                 GATHER_WORD(real, (samples + 2 * step), word));
}

// Counts the samples that are neither finite nor empty, and records pixel (of the film) and index of the first few.
static void note_invalid(global const float *samples, FilmPlace at, uint band_first, mask valid, uint s,
                         uint pass_first, uint pass_samples, volatile global uint *invalid) {
    int ok[LANES];
    STORE(to_ints(valid), ok);
    for (int lane = at.begin; lane < at.end; lane++) {
        uint pixel = band_first + (uint)(at.first + lane);
        if (ok[lane] || as_uint(samples[SAMPLE_WORD(pixel, s, pass_samples)]) == OPAL_SAMPLE_EMPTY) continue;
        uint record = atomic_inc(invalid);
        if (record < OPAL_INVALID_RECORDS) {
            invalid[1 + 2 * record] = pixel;
            invalid[2 + 2 * record] = pass_first + s;
        }
    }
}

// Adds each pixel's own samples, for the box filter and for statistics. invalid: how many samples are not finite, then
// pixel and index of the first OPAL_INVALID_RECORDS
kernel void gather(global const Settings *settings, global const float *samples, uint pass_first, uint pass_samples,
                   uint band_first, uint band_pixels, uint empty, global float *film, global uint *counts,
                   volatile global uint *invalid) {
    uint first = (uint)get_global_id(0) * LANES;
    if (first >= band_pixels) return;
    FilmPlace at = film_place((int)first, LANES, band_pixels, empty);
    Sum sums[3], squares[4];
    for (uint c = 0; c < 3; c++) sums[c] = film_load(film, at, FILM_SUM + c, FILM_SUM_LOW + c);
    for (uint c = 0; c < 4; c++) squares[c] = film_load(film, at, FILM_SQUARES + c, FILM_SQUARES_LOW + c);
    uints count = (uints)(0);
    if (!at.empty) count = GATHER_WORD(uints, counts, at.pixel);
    v3 colors[LANES];
    uint loaded = 0, next = 0; // of `colors`
    for (uint s = 0; s < pass_samples; s++) {
        if (next == loaded) {
            loaded = load_colors(samples, band_first + at.pixel, s, pass_samples, colors);
            next = 0;
        }
        fetch_next(samples, band_first + first, s, pass_samples);
        v3 c = colors[next++];
        mask valid = is_finite(c);
        if (ANY(!valid)) note_invalid(samples, at, band_first, valid, s, pass_first, pass_samples, invalid);
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
    for (int lane = at.begin; lane < at.end; lane++) counts[at.first + lane] = count_of[lane];
}

// How many pixels away along an axis the filter reaches. No pixel of the film is farther away than its size.
static int filter_reach(global const Settings *settings, uint size) {
    float reach = max(ceil(settings->filter_radius - 0.5f), 0.0f);
    return (int)min(reach, (float)(size - 1u));
}

// The sample's place in its pixel (x, y) of the film, from its middle.
static v2 offset_from_middle(global const Settings *settings, uints x, uints y, uint sample) {
    Scene scene = {settings}; // film_offset reads no table
    uints of_image = (y + settings->film.top) * settings->width + (x + settings->film.left);
    v2 offset = film_offset(&scene, sampler_start(of_image, (uints)(sample), settings->seed));
    return v2_of(offset.x - R(0.5), offset.y - R(0.5));
}

// For wide filters: adds the samples of all pixels within the filter's radius, weighted by the filter.
kernel void gather_around(global const Settings *settings, global const float *samples, uint pass_first,
                          uint pass_samples, uint band_first, uint band_pixels, uint empty, global float *weighted) {
    uint first = (uint)get_global_id(0) * LANES;
    if (first >= band_pixels) return;
    FilmPlace at = film_place((int)first, LANES, band_pixels, empty);
    uint width = settings->film.width, height = settings->film.height;
    Sum sums[4];
    for (uint c = 0; c < 4; c++) sums[c] = film_load(weighted, at, FILM_WEIGHTED + c, FILM_WEIGHTED_LOW + c);
    uints of_film = band_first + at.pixel, x = of_film % width, y = of_film / width;
    int across = filter_reach(settings, width), down = filter_reach(settings, height);
    for (uint s = 0; s < pass_samples; s++)
        for (int dy = -down; dy <= down; dy++)
            for (int dx = -across; dx <= across; dx++) {
                uints nx = x + (uint)dx, ny = y + (uint)dy; // below 0 wraps to far beyond the film
                mask inside = to_mask(nx < width) & to_mask(ny < height);
                uints pixel = uints_pick(inside, ny * width + nx, (uints)(0));
                v2 offset = offset_from_middle(settings, nx, ny, pass_first + s);
                real w = filter_1d(settings, offset.x + (real1)dx) * filter_1d(settings, offset.y + (real1)dy);
                v3 c = sample_color(samples, pixel, s, pass_samples);
                mask valid = inside & is_finite(c);
                sums[0] = sum_add(sums[0], w * c.x, valid);
                sums[1] = sum_add(sums[1], w * c.y, valid);
                sums[2] = sum_add(sums[2], w * c.z, valid);
                sums[3] = sum_add(sums[3], w, valid);
            }
    for (uint c = 0; c < 4; c++) film_store(weighted, at, FILM_WEIGHTED + c, FILM_WEIGHTED_LOW + c, sums[c]);
}
