// film: the kernels of the film. They are a program of their own, whose text is the same for all scenes.
#include "film/gather.cl"
#include "kernels/queue.cl"
#include "shared/film.h"
#include "shared/types.h"
#if LANES == 1
#include "film/one_lane/samples.cl"
#else
#include "film/many_lanes/samples.cl"
#include "film/many_lanes/strips.cl"
#endif

// Marks the samples of items that were not rendered (an interrupted pass) as empty.
kernel void clear(global const Settings *settings, global float *samples, uint first_item, uint items, uint tile_width,
                  uint tile_height, uint chunks, uint chunk_samples, uint pass_first, uint pass_samples) {
    Queue q = queue_of(settings, first_item + (uint)get_global_id(0), items, tile_width, tile_height, chunks,
                       chunk_samples, pass_first, pass_samples);
    for (uint y = q.top; y < q.bottom; y++)
        for (uint x = q.left; x < q.right; x++)
            for (uint s = 0; s < q.samples; s++) {
                uint pixel = (y - settings->film.top) * settings->film.width + (x - settings->film.left);
                uint sample = q.first_sample - pass_first + s;
                samples[SAMPLE_WORD(pixel, sample, pass_samples)] = as_float(OPAL_SAMPLE_EMPTY);
            }
}
