// many_lanes/path_starts: camera paths are started LANES at a time and wait for a lane that ends, because a path that
// is started for one lane alone leaves the others idle.
#include "cameras/dispatch.cl"
#include "cameras/interface.cl"
#include "core/lanes.cl"
#include "core/rng.cl"
#include "integrators/steps.cl"
#include "kernels/queue.cl"
#include "scene.cl"

// LANES camera paths. Their origins are kept only where they differ.
enum { LANES_OF_ORIGINS = CAMERAS_OF_MANY_ORIGINS > 0 ? LANES : 1 };
typedef struct {
    uint pixel[LANES], sample[LANES], key0[LANES], key1[LANES];
    real1 o[3][LANES_OF_ORIGINS], d[3][LANES], tmin[LANES], tmax[LANES];
} CameraPaths;

// Starts the queue's next samples, at most LANES. Returns how many there are.
static int start_paths(const Scene *scene, Queue *queue, CameraPaths *paths) {
    uint xs[LANES], ys[LANES];
    int count = 0;
    for (int i = 0; i < LANES; i++) {
        xs[i] = queue->x;
        ys[i] = queue->y;
        paths->sample[i] = queue->first_sample + queue->sample;
        if (is_empty(queue)) continue;
        count++;
        advance(queue);
    }
    uints x = LOAD(uints, xs), y = LOAD(uints, ys);
    Sampler sampler = sampler_start(y * scene->settings->width + x, LOAD(uints, paths->sample), scene->settings->seed);
    Ray ray = camera_ray(scene, x, y, film_offset(scene, sampler), lens_numbers(scene, sampler));
    STORE(sampler.pixel, paths->pixel);
    STORE(sampler.key0, paths->key0);
    STORE(sampler.key1, paths->key1);
    if (CAMERAS_OF_MANY_ORIGINS > 0) {
        STORE(ray.o.x, paths->o[0]);
        STORE(ray.o.y, paths->o[1]);
        STORE(ray.o.z, paths->o[2]);
    }
    STORE(ray.d.x, paths->d[0]);
    STORE(ray.d.y, paths->d[1]);
    STORE(ray.d.z, paths->d[2]);
    STORE(ray.tmin, paths->tmin);
    STORE(ray.tmax, paths->tmax);
    return count;
}

// Where paths come from: the queue, and the paths started from it.
typedef struct {
    Queue queue;
    CameraPaths ready, taken; // paths that wait, from `next` to `end`; the paths that each lane took last
    int next, end;
} Starts;

static void prepare_starts(const Scene *scene, Queue queue, Starts *starts) {
    CameraPaths none = {{0}};
    starts->queue = queue;
    starts->next = starts->end = 0; // refill starts the first ones: here their code would be compiled once more
    starts->taken = none;
}

// Hands the ended lanes, a bit each, the next camera paths, as far as there are any. Returns the lanes that got one.
static CALLED mask refill(const Scene *scene, Starts *starts, Path *path, uint ended) {
    uint taken = 0;
    CameraPaths *from = &starts->ready, *to = &starts->taken;
    for (; ended; ended &= ended - 1) {
        if (starts->next == starts->end) {
            if (is_empty(&starts->queue)) break;
            starts->next = 0;
            starts->end = start_paths(scene, &starts->queue, from);
        }
        int lane = lowest_lane(ended), k = starts->next++;
        taken |= 1u << lane;
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
    mask start = mask_of(taken);
    v3 o = v3_from(scene->cameras->origin);
    if (CAMERAS_OF_MANY_ORIGINS > 0) o = v3_of(LOAD(real, to->o[0]), LOAD(real, to->o[1]), LOAD(real, to->o[2]));
    path->ray.o = v3_pick(start, o, path->ray.o);
    v3 d = v3_of(LOAD(real, to->d[0]), LOAD(real, to->d[1]), LOAD(real, to->d[2]));
    path->ray.d = v3_pick(start, d, path->ray.d);
    path->ray.tmin = start ? LOAD(real, to->tmin) : path->ray.tmin;
    path->ray.tmax = start ? LOAD(real, to->tmax) : path->ray.tmax;
    path->throughput = v3_pick(start, v3_all((real)(1)), path->throughput);
    path->radiance = v3_pick(start, v3_all((real)(0)), path->radiance);
    path->lost = v3_pick(start, v3_all((real)(0)), path->lost);
    path->eta = start ? (real)(1) : path->eta;
    path->pdf = start ? (real)(1) : path->pdf;
    path->specular = start | path->specular;
    path->depth = uints_pick(start, (uints)(1), path->depth);
    path->sampler.pixel = uints_pick(start, LOAD(uints, to->pixel), path->sampler.pixel);
    path->sampler.sample = uints_pick(start, LOAD(uints, to->sample), path->sampler.sample);
    path->sampler.key0 = uints_pick(start, LOAD(uints, to->key0), path->sampler.key0);
    path->sampler.key1 = uints_pick(start, LOAD(uints, to->key1), path->sampler.key1);
    return start;
}
