// queue: the samples of a work-item, and the ones that are finished. one_lane/ and many_lanes/path_starts.cl start
// their paths.
#include "core/lanes.cl"
#include "film/sums.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "shared/counters.h"
#include "shared/film.h"
#include "shared/types.h"

// The samples of a work-item: pixels of its tile, row by row, each with `samples` samples from first_sample on.
typedef struct {
    uint left, top, right, bottom;  // the tile's pixels, in the whole image
    uint samples, first_sample;     // of this work-item, in each pixel
    uint pass_first, pass_samples;  // of the pass
    uint x, y, sample;              // the next one
} Queue;

// The samples of work-item `item` of a pass: of tile item / chunks the chunk item % chunks, which has chunk_samples
// samples a pixel. An item past the end has none; the last launch reaches beyond the end, because all launches have one
// shape.
static Queue queue_of(global const Settings *settings, uint item, uint items, uint tile_width, uint tile_height,
                      uint chunks, uint chunk_samples, uint pass_first, uint pass_samples) {
    PixelWindow film = settings->film;
    uint columns = (film.width + tile_width - 1) / tile_width;
    uint tile = item / chunks, chunk = item - tile * chunks;
    uint left = film.left + (tile % columns) * tile_width, top = film.top + (tile / columns) * tile_height;
    uint done = min(chunk * chunk_samples, pass_samples);
    uint samples = item < items ? min(chunk_samples, pass_samples - done) : 0;
    uint right = min(left + tile_width, film.left + film.width);
    uint bottom = min(top + tile_height, film.top + film.height);
    Queue queue = {left, top, right, samples ? bottom : top, samples, pass_first + done, pass_first, pass_samples,
                   left, top, 0};
    return queue;
}

static bool is_empty(const Queue *queue) { return queue->y == queue->bottom; }

// Goes on to the next sample.
static void advance(Queue *queue) {
    if (++queue->sample == queue->samples) {
        queue->sample = 0;
        if (++queue->x == queue->right) {
            queue->x = queue->left;
            queue->y++;
        }
    }
}

// Stores the radiance of the `ended` paths, a bit each, as finished samples. In counting builds the sample of the first
// one gets counters instead: the rays, shadow rays and rounds since a path ended before; the others get 0.
static void retire(const Scene *scene, global float *samples, const Queue *queue, const Path *path, uint ended) {
    uint place[LANES];
    real1 r[LANES], g[LANES], b[LANES];
    uints pixel = film_pixel(scene->settings, path->sampler.pixel);
    STORE(pixel * queue->pass_samples + (path->sampler.sample - queue->pass_first), place);
    STORE(path->radiance.x, r);
    STORE(path->radiance.y, g);
    STORE(path->radiance.z, b);
    if (OPAL_COUNT_TESTS) {
        STORE((real)(0), r);
        STORE((real)(0), g);
        STORE((real)(0), b);
        r[lowest_lane(ended)] = scene->counters[COUNTER_rays];
        g[lowest_lane(ended)] = scene->counters[COUNTER_shadow_rays];
        b[lowest_lane(ended)] = scene->counters[COUNTER_rounds];
        for (uint k = 0; k < COUNTERS; k++) scene->counters[k] = 0;
    }
    for (; ended; ended &= ended - 1) {
        int lane = lowest_lane(ended);
        global float *sample = samples + OPAL_SAMPLE_FLOATS * (ulong)place[lane];
        sample[0] = r[lane];
        sample[1] = g[lane];
        sample[2] = b[lane];
    }
}
