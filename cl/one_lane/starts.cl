// one_lane/starts: where a kernel carries one lane, a path that ends is followed by the next one of the queue. None are made ahead: the
// queue of started paths in kernels/render.cl fills all lanes of a vector with work that one lane would do alone.
typedef struct { int ready, taken, next, end; } NoStarts;

static int start_none(const Scene *scene, Queue *queue, int *ready) { return *ready = 0; }

// Starts the queue's next camera path, if there is one. Returns whether there was.
static mask start_next(const Scene *scene, Queue *queue, NoStarts *starts, Path *path, uint ended) {
    if (queue->y == queue->bottom) return NO_LANES;
    uint x = queue->x, y = queue->y, sample = queue->first_sample + queue->sample;
    if (++queue->sample == queue->samples) {
        queue->sample = 0;
        if (++queue->x == queue->right) {
            queue->x = queue->left;
            queue->y++;
        }
    }
    path->sampler = sampler_start(y * scene->settings->width + x, sample, scene->settings->seed);
    path->ray = camera_ray(scene, x, y, film_offset(scene, path->sampler));
    path->throughput = v3_all(1);
    path->radiance = path->lost = v3_all(0);
    path->eta = path->pdf = 1;
    path->direct = ALL_LANES;
    path->depth = 1;
    return ALL_LANES;
}

// The kernel takes these
#define Starts NoStarts
#define start_paths start_none
#define refill start_next
