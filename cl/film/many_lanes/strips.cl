// many_lanes/strips: gather_around for filters that reach no more than OPAL_STRIP_REACH pixels. A work-item adds a part
// of a strip of the film, row after row of samples, so that the weights of a sample are computed once for all pixels
// that it reaches. The sums are the same, bit for bit: each pixel's samples come in the same order.
#include "core/lanes.cl"
#include "core/math.cl"
#include "film/filter.cl"
#include "film/gather.cl"
#include "film/many_lanes/samples.cl"
#include "film/sums.cl"
#include "shared/film.h"
#include "shared/types.h"

enum {
    STRIP = OPAL_STRIP_VECTORS * LANES,                          // pixels across
    AROUND = (2 * OPAL_STRIP_REACH + LANES - 1) / LANES * LANES, // at least those that it reaches beside the strip
    STRIP_WEIGHTS = 2 * OPAL_STRIP_REACH + 1
};

// A sample of each pixel of a row, from `across` pixels left of the strip on: its colour, and its weights along x and
// along y for the pixels around it. Colour and weights along y are 0 where the sample does not count.
typedef struct {
    real1 color[3][STRIP + AROUND], x[STRIP_WEIGHTS][STRIP + AROUND], y[STRIP_WEIGHTS][STRIP + AROUND];
} SampleRow;

static void read_row(global const Settings *settings, global const float *samples, uint left, uint y, uint pass_first,
                     uint s, uint pass_samples, int across, int down, SampleRow *row) {
    uint width = settings->film.width;
    for (int first = 0; first < STRIP + 2 * across; first += LANES) {
        uints x = left - (uint)across + (uint)first + LANE_NUMBERS; // below 0 wraps to far beyond the film
        mask inside = to_mask(x < width);
        v2 offset = offset_from_middle(settings, x, (uints)(y), pass_first + s);
        v3 c = sample_color(samples, uints_pick(inside, y * width + x, (uints)(0)), s, pass_samples);
        mask valid = inside & is_finite(c);
        c = v3_pick(valid, c, v3_all((real)(0)));
        STORE(c.x, row->color[0] + first);
        STORE(c.y, row->color[1] + first);
        STORE(c.z, row->color[2] + first);
        for (int dx = -across; dx <= across; dx++)
            STORE(filter_1d(settings, offset.x + (real1)dx), row->x[dx + across] + first);
        for (int dy = -down; dy <= down; dy++)
            STORE(valid ? filter_1d(settings, offset.y + (real1)dy) : (real)(0), row->y[dy + down] + first);
    }
}

kernel void gather_strips(global const Settings *settings, global const float *samples, uint pass_first,
                          uint pass_samples, uint band_first, uint band_pixels, uint empty, global float *weighted) {
    uint width = settings->film.width, height = settings->film.height, strips = (width + STRIP - 1) / STRIP;
    uint item = (uint)get_global_id(0), left = item % strips * STRIP;
    uint top = band_first / width + item / strips * OPAL_STRIP_ROWS;
    uint bottom = min(top + OPAL_STRIP_ROWS, (band_first + band_pixels - 1) / width + 1);
    if (top >= bottom) return;
    int across = filter_reach(settings, width), down = filter_reach(settings, height);
    Sum sums[OPAL_STRIP_ROWS][OPAL_STRIP_VECTORS][4];
    for (uint y = top; y < bottom; y++)
        for (uint v = 0; v < OPAL_STRIP_VECTORS; v++) {
            uint x = left + v * LANES;
            FilmPlace at = film_place((int)(y * width + x - band_first), (int)width - (int)x, band_pixels, empty);
            for (uint c = 0; c < 4; c++)
                sums[y - top][v][c] = film_load(weighted, at, FILM_WEIGHTED + c, FILM_WEIGHTED_LOW + c);
        }
    SampleRow row;
    for (uint s = 0; s < pass_samples; s++)
        for (int from = max((int)top - down, 0); from < min((int)bottom + down, (int)height); from++) {
            read_row(settings, samples, left, (uint)from, pass_first, s, pass_samples, across, down, &row);
            for (int y = max((int)top, from - down); y < min((int)bottom, from + down + 1); y++)
                for (uint v = 0; v < OPAL_STRIP_VECTORS; v++) {
                    Sum *pixels = sums[y - (int)top][v];
                    Sum r = pixels[0], g = pixels[1], b = pixels[2], weights = pixels[3];
                    const real1 *along_y = row.y[from - y + down];
                    for (int dx = 0; dx <= 2 * across; dx++) {
                        uint at = v * LANES + (uint)dx;
                        real w = LOAD(real, row.x[dx] + at) * LOAD(real, along_y + at);
                        r = sum_add(r, w * LOAD(real, row.color[0] + at), ALL_LANES);
                        g = sum_add(g, w * LOAD(real, row.color[1] + at), ALL_LANES);
                        b = sum_add(b, w * LOAD(real, row.color[2] + at), ALL_LANES);
                        weights = sum_add(weights, w, ALL_LANES);
                    }
                    pixels[0] = r;
                    pixels[1] = g;
                    pixels[2] = b;
                    pixels[3] = weights;
                }
        }
    for (uint y = top; y < bottom; y++)
        for (uint v = 0; v < OPAL_STRIP_VECTORS; v++) {
            uint x = left + v * LANES;
            FilmPlace at = film_place((int)(y * width + x - band_first), (int)width - (int)x, band_pixels, empty);
            for (uint c = 0; c < 4; c++)
                film_store(weighted, at, FILM_WEIGHTED + c, FILM_WEIGHTED_LOW + c, sums[y - top][v][c]);
        }
}
