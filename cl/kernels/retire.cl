// retire: finished paths leave their samples in the memory of the pass.
#include "core/lanes.cl"
#include "integrators/steps.cl"
#include "kernels/queue.cl"
#include "scene.cl"
#include "shared/counters.h"
#include "shared/film.h"
#include "shared/types.h"
#if LANES == 1
#include "film/one_lane/samples.cl"
#else
#include "film/many_lanes/samples.cl"
#endif

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
    v3 light = path->radiance;
    uint samples_of_pixel = queue->pass_samples, step = SAMPLE_CHANNEL(1, samples_of_pixel);
    uints pixel = film_pixel(scene->settings, path->sampler.pixel);
    uints word = SAMPLE_WORD(pixel, path->sampler.sample - queue->pass_first, samples_of_pixel);
    uint place[LANES];
    STORE(word, place);
    bool together = LANES > 1 && ended == lanes_of(ALL_LANES) && !ANY(to_mask(word != place[0] + LANE_NUMBERS));
    if (together && !OPAL_COUNT_TESTS) { // consecutive samples of a pixel, as they were started
        global float *first = samples + place[0];
        STORE(to_floats(light.x), first);
        STORE(to_floats(light.y), first + step);
        STORE(to_floats(light.z), first + 2 * step);
        return;
    }
    real1 r[LANES], g[LANES], b[LANES];
    STORE(light.x, r);
    STORE(light.y, g);
    STORE(light.z, b);
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
        global float *sample = samples + place[lane];
        sample[0] = r[lane];
        sample[step] = g[lane];
        sample[2 * step] = b[lane];
    }
}
