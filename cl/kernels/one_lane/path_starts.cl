// one_lane/path_starts: where a kernel carries one lane, the next path of the queue follows a path that ends. Paths are
// not started ahead as in many_lanes/path_starts.cl, where that fills all lanes of a vector.
#include "cameras/dispatch.cl"
#include "cameras/interface.cl"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "integrators/steps.cl"
#include "kernels/queue.cl"
#include "scene.cl"

// Where paths come from.
typedef struct {
    Queue queue;
} Starts;

static void prepare_starts(const Scene *scene, Queue queue, Starts *starts) { starts->queue = queue; }

// Starts the queue's next camera path, if there is one. Returns whether there was.
static mask refill(const Scene *scene, Starts *starts, Path *path, uint ended) {
    Queue *queue = &starts->queue;
    if (is_empty(queue)) return NO_LANES;
    uint x = queue->x, y = queue->y, sample = queue->first_sample + queue->sample;
    advance(queue);
    path->sampler = sampler_start(y * scene->settings->width + x, sample, scene->settings->seed);
    path->ray = camera_ray(scene, x, y, film_offset(scene, path->sampler), lens_numbers(scene, path->sampler));
    path->throughput = v3_all(1);
    path->radiance = path->lost = v3_all(0);
    path->eta = path->pdf = 1;
    path->specular = ALL_LANES;
    path->depth = 1;
    return ALL_LANES;
}
