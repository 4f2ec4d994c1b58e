// many_lanes/path_starts: camera paths are started LANES at a time and wait for a lane that ends, because a path that
// is started for one lane alone leaves the others idle.
#include "cameras/dispatch.cl"
#include "cameras/interface.cl"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "integrators/steps.cl"
#include "kernels/queue.cl"
#include "scene.cl"

// Camera paths that have not begun, one a lane.
typedef struct {
    Sampler sampler;
    Ray ray;
    int count; // those of the first lanes
} CameraPaths;

// The queue's next samples, at most LANES. Returns how many there are.
static int take_samples(Queue *queue, uints *x, uints *y, uints *sample) {
    if (queue->samples - queue->sample >= LANES) { // of one pixel
        *x = queue->x;
        *y = queue->y;
        *sample = queue->first_sample + queue->sample + LANE_NUMBERS;
        queue->sample += LANES - 1;
        advance(queue);
        return LANES;
    }
    uint xs[LANES], ys[LANES], samples[LANES];
    int count = 0;
    for (int i = 0; i < LANES; i++) {
        xs[i] = queue->x;
        ys[i] = queue->y;
        samples[i] = queue->first_sample + queue->sample;
        if (is_empty(queue)) continue;
        count++;
        advance(queue);
    }
    *x = LOAD(uints, xs);
    *y = LOAD(uints, ys);
    *sample = LOAD(uints, samples);
    return count;
}

// Starts the samples of a queue that is not empty.
static CameraPaths start_paths(const Scene *scene, Queue *queue) {
    CameraPaths paths;
    uints x, y, sample;
    paths.count = take_samples(queue, &x, &y, &sample);
    paths.sampler = sampler_start(y * scene->settings->width + x, sample, scene->settings->seed);
    paths.ray = camera_ray(scene, x, y, film_offset(scene, paths.sampler), lens_numbers(scene, paths.sampler));
    return paths;
}

// Camera paths in memory, to be read one by one. Their origins are kept only where they differ.
enum { WAITING = 2 * LANES, WAITING_ORIGINS = CAMERAS_OF_MANY_ORIGINS > 0 ? WAITING : LANES };
typedef struct {
    uint pixel[WAITING], sample[WAITING], key0[WAITING], key1[WAITING];
    real1 o[3][WAITING_ORIGINS], d[3][WAITING], tmin[WAITING], tmax[WAITING];
} WaitingPaths;

static void store_paths(CameraPaths paths, uint first, WaitingPaths *to) {
    STORE(paths.sampler.pixel, to->pixel + first);
    STORE(paths.sampler.sample, to->sample + first);
    STORE(paths.sampler.key0, to->key0 + first);
    STORE(paths.sampler.key1, to->key1 + first);
    if (CAMERAS_OF_MANY_ORIGINS > 0) {
        STORE(paths.ray.o.x, to->o[0] + first);
        STORE(paths.ray.o.y, to->o[1] + first);
        STORE(paths.ray.o.z, to->o[2] + first);
    }
    STORE(paths.ray.d.x, to->d[0] + first);
    STORE(paths.ray.d.y, to->d[1] + first);
    STORE(paths.ray.d.z, to->d[2] + first);
    STORE(paths.ray.tmin, to->tmin + first);
    STORE(paths.ray.tmax, to->tmax + first);
}

static CameraPaths load_paths(const Scene *scene, const WaitingPaths *from) {
    v3 o = v3_from(scene->cameras->origin);
    if (CAMERAS_OF_MANY_ORIGINS > 0) o = v3_of(LOAD(real, from->o[0]), LOAD(real, from->o[1]), LOAD(real, from->o[2]));
    CameraPaths paths = {
        {LOAD(uints, from->pixel), LOAD(uints, from->sample), LOAD(uints, from->key0), LOAD(uints, from->key1)},
        {o, v3_of(LOAD(real, from->d[0]), LOAD(real, from->d[1]), LOAD(real, from->d[2])),
         LOAD(real, from->tmin), LOAD(real, from->tmax)},
        LANES};
    return paths;
}

static void copy_path(const WaitingPaths *from, uint k, WaitingPaths *to, uint lane) {
    to->pixel[lane] = from->pixel[k];
    to->sample[lane] = from->sample[k];
    to->key0[lane] = from->key0[k];
    to->key1[lane] = from->key1[k];
    for (int axis = 0; axis < 3; axis++) to->d[axis][lane] = from->d[axis][k];
    if (CAMERAS_OF_MANY_ORIGINS > 0)
        for (int axis = 0; axis < 3; axis++) to->o[axis][lane] = from->o[axis][k];
    to->tmin[lane] = from->tmin[k];
    to->tmax[lane] = from->tmax[k];
}

// Where paths come from: the queue, and the paths started from it.
typedef struct {
    Queue queue;
    WaitingPaths ready, taken; // paths that wait, a ring; in its first LANES places the paths that each lane took last
    uint next, end;            // of the ring: the first path that waits, the place after the last; modulo WAITING
} Starts;

static void prepare_starts(const Scene *scene, Queue queue, Starts *starts) {
    WaitingPaths none = {{0}};
    starts->queue = queue;
    starts->next = starts->end = 0; // refill starts the first ones: here their code would be compiled once more
    starts->taken = none;
}

// Hands the ended lanes, a bit each, the next camera paths, as far as there are any. Returns the lanes that got one.
// Where all lanes have ended, as those of short paths do together, paths go from the camera to the lanes.
static CALLED mask refill(const Scene *scene, Starts *starts, Path *path, uint ended) {
    uint wanted = popcount(ended), waiting = starts->end - starts->next;
    CameraPaths paths;
    uint taken = 0;
    bool at_once = waiting == 0 && wanted == LANES;
    if (waiting < wanted && !is_empty(&starts->queue)) {
        paths = start_paths(scene, &starts->queue);
        if (at_once) {
            taken = (1u << paths.count) - 1;
        } else {
            store_paths(paths, starts->end % WAITING, &starts->ready);
            starts->end += paths.count;
        }
    }
    if (!at_once) {
        for (; ended && starts->next != starts->end; ended &= ended - 1) {
            int lane = lowest_lane(ended);
            taken |= 1u << lane;
            copy_path(&starts->ready, starts->next++ % WAITING, &starts->taken, lane);
        }
        paths = load_paths(scene, &starts->taken);
    }
    mask start = mask_of(taken);
    path->ray = ray_pick(start, paths.ray, path->ray);
    path->throughput = v3_pick(start, v3_all((real)(1)), path->throughput);
    path->radiance = v3_pick(start, v3_all((real)(0)), path->radiance);
    path->lost = v3_pick(start, v3_all((real)(0)), path->lost);
    path->eta = start ? (real)(1) : path->eta;
    path->pdf = start ? (real)(1) : path->pdf;
    path->specular = start | path->specular;
    path->depth = uints_pick(start, (uints)(1), path->depth);
    path->sampler.pixel = uints_pick(start, paths.sampler.pixel, path->sampler.pixel);
    path->sampler.sample = uints_pick(start, paths.sampler.sample, path->sampler.sample);
    path->sampler.key0 = uints_pick(start, paths.sampler.key0, path->sampler.key0);
    path->sampler.key1 = uints_pick(start, paths.sampler.key1, path->sampler.key1);
    return start;
}
