// retire: finished paths leave their samples in the memory of the pass.
#include "core/lanes.cl"
#include "integrators/steps.cl"
#include "kernels/queue.cl"
#include "scene.cl"
#include "shared/counters.h"
#include "shared/film.h"
#include "shared/types.h"

// The film's pixel of the image's pixel y * width + x. The film holds a window of the image, and random numbers are
// drawn by the pixel of the image, so that a crop shows what the whole image shows there.
static uints film_pixel(global const Settings *settings, uints pixel) {
    PixelWindow film = settings->film;
    uint width = settings->width;
    if (film.width == width) return pixel - film.top * width;
    uints y = pixel / width, x = pixel - y * width;
    return (y - film.top) * film.width + (x - film.left);
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
