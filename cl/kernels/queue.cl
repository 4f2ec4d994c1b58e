// queue: the samples of a work-item, in the order in which they are rendered.
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
