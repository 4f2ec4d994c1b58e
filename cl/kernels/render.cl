// render: the megakernel. A work-item carries LANES paths of its own tile of pixels; a path that ends is replaced in place by
// the next sample of the tile's queue, so that lanes stay full.
#include "lanes.cl"
#include "math.cl"
#include "rng.cl"
#include "warp.cl"
#include "fresnel.cl"
#include "scene.cl"
#include "triangle.cl"
#include "bvh.cl"
#include "surface.cl"
#include "bsdf.cl"
#include "emitter.cl"
#include "camera.cl"
#include "film.cl"
#include "lighting.cl"
#include "integrators/normals.cl"
#include "integrators/ao.cl"
#include "integrators/simple.cl"
#include "integrators/whitted.cl"
#include "integrators/direct_lighting.cl"
#include "integrators/path.cl"

// One step of a path: its ray has hit `hit`. Returns the lanes that go on with a new ray.
static mask integrator_step(const Scene *scene, Path *path, Hit hit, mask live) {
#define STEP(axis, name, help) if (CHOSEN(scene, integrator, name)) return name##_step(scene, path, hit, live);
    OPAL_CHOICES_integrator(STEP)
    return NO_LANES;
}

// The samples of a work-item: pixels of its tile, row by row, each with `samples` samples from first_sample on.
typedef struct {
    uint left, top, right, bottom;  // the tile's pixels
    uint samples, first_sample;     // of this work-item, in each pixel
    uint pass_first, pass_samples;  // of the pass
    uint x, y, sample;              // the next one
} Queue;

// Camera paths, one an entry.
typedef struct {
    uint pixel[LANES], sample[LANES], key0[LANES], key1[LANES];
    real1 d[3][LANES], tmin[LANES], tmax[LANES];
} CameraPaths;

// The next samples of the queue as camera paths, LANES at once; returns how many there are.
static int start_paths(const Scene *scene, Queue *queue, CameraPaths *paths) {
    uint xs[LANES], ys[LANES];
    int count = 0;
    for (int i = 0; i < LANES; i++) {
        xs[i] = queue->x;
        ys[i] = queue->y;
        paths->sample[i] = queue->first_sample + queue->sample;
        if (queue->y == queue->bottom) continue;
        count++;
        if (++queue->sample == queue->samples) {
            queue->sample = 0;
            if (++queue->x == queue->right) {
                queue->x = queue->left;
                queue->y++;
            }
        }
    }
    uints x = LOAD(uints, xs), y = LOAD(uints, ys);
    Sampler sampler = sampler_start(y * scene->settings->width + x, LOAD(uints, paths->sample), scene->settings->seed);
    Ray ray = camera_ray(scene, x, y, film_offset(scene, sampler));
    STORE(sampler.pixel, paths->pixel);
    STORE(sampler.key0, paths->key0);
    STORE(sampler.key1, paths->key1);
    STORE(ray.d.x, paths->d[0]);
    STORE(ray.d.y, paths->d[1]);
    STORE(ray.d.z, paths->d[2]);
    STORE(ray.tmin, paths->tmin);
    STORE(ray.tmax, paths->tmax);
    return count;
}

// Camera paths that were made together and wait for a lane, from `next` to `end`, and those that lanes took last.
typedef struct {
    CameraPaths ready, taken;
    int next, end;
} Starts;

// Hands the ended lanes the next camera paths, where there are any. Returns the lanes that got one.
static mask refill(const Scene *scene, Queue *queue, Starts *starts, Path *path, uint ended) {
    uint taken = 0;
    CameraPaths *from = &starts->ready, *to = &starts->taken;
    for (; ended; ended &= ended - 1) {
        if (starts->next == starts->end) {
            if (queue->y == queue->bottom) break;
            starts->next = 0;
            starts->end = start_paths(scene, queue, from);
        }
        int lane = lowest_lane(ended), k = starts->next++;
        taken |= 1u << lane;
        to->pixel[lane] = from->pixel[k];
        to->sample[lane] = from->sample[k];
        to->key0[lane] = from->key0[k];
        to->key1[lane] = from->key1[k];
        for (int axis = 0; axis < 3; axis++) to->d[axis][lane] = from->d[axis][k];
        to->tmin[lane] = from->tmin[k];
        to->tmax[lane] = from->tmax[k];
    }
    mask start = mask_of(taken);
    path->ray.o = v3_pick(start, v3_from(scene->settings->camera_origin), path->ray.o);
    path->ray.d = v3_pick(start, v3_of(LOAD(real, to->d[0]), LOAD(real, to->d[1]), LOAD(real, to->d[2])), path->ray.d);
    path->ray.tmin = start ? LOAD(real, to->tmin) : path->ray.tmin;
    path->ray.tmax = start ? LOAD(real, to->tmax) : path->ray.tmax;
    path->throughput = v3_pick(start, v3_all((real)(1)), path->throughput);
    path->radiance = v3_pick(start, v3_all((real)(0)), path->radiance);
    path->lost = v3_pick(start, v3_all((real)(0)), path->lost);
    path->eta = start ? (real)(1) : path->eta;
    path->pdf = start ? (real)(1) : path->pdf;
    path->direct = start | path->direct;
    path->depth = uints_pick(start, (uints)(1), path->depth);
    path->sampler.pixel = uints_pick(start, LOAD(uints, to->pixel), path->sampler.pixel);
    path->sampler.sample = uints_pick(start, LOAD(uints, to->sample), path->sampler.sample);
    path->sampler.key0 = uints_pick(start, LOAD(uints, to->key0), path->sampler.key0);
    path->sampler.key1 = uints_pick(start, LOAD(uints, to->key1), path->sampler.key1);
    return start;
}
#include "one_lane/starts.cl"
// Puts the radiance of the paths that ended into their slots; where tests are counted, the rays, shadow rays and rounds since a path
// ended before instead, into the slot of the first.
static void retire(const Scene *scene, global float *slots, const Queue *queue, const Path *path, uint ended) {
    uint place[LANES];
    real1 r[LANES], g[LANES], b[LANES];
    STORE(path->sampler.pixel * queue->pass_samples + (path->sampler.sample - queue->pass_first), place);
    STORE(path->radiance.x, r);
    STORE(path->radiance.y, g);
    STORE(path->radiance.z, b);
    if (OPAL_COUNT_TESTS) {
        STORE((real)(0), r);
        STORE((real)(0), g);
        STORE((real)(0), b);
        r[lowest_lane(ended)] = scene->tests[TESTS_rays];
        g[lowest_lane(ended)] = scene->tests[TESTS_shadow_rays];
        b[lowest_lane(ended)] = scene->tests[TESTS_rounds];
        for (uint k = 0; k < TESTS_KINDS; k++) scene->tests[k] = 0;
    }
    for (; ended; ended &= ended - 1) {
        int lane = lowest_lane(ended);
        global float *slot = slots + 3 * (ulong)place[lane];
        slot[0] = r[lane];
        slot[1] = g[lane];
        slot[2] = b[lane];
    }
}

// The samples of work-item `item` of a pass: chunk item % chunks, of chunk_samples samples a pixel, of tile item / chunks. None
// for items past the end: a launch always has the same shape, so the last one reaches over it.
static Queue queue_of(global const Settings *settings, uint item, uint items, uint tile_width, uint tile_height, uint chunks,
               uint chunk_samples, uint pass_first, uint pass_samples) {
    uint width = settings->width, height = settings->height;
    uint columns = (width + tile_width - 1) / tile_width;
    uint tile = item / chunks, chunk = item - tile * chunks;
    uint left = (tile % columns) * tile_width, top = (tile / columns) * tile_height;
    uint done = min(chunk * chunk_samples, pass_samples);
    uint samples = item < items ? min(chunk_samples, pass_samples - done) : 0;
    Queue queue = {left, top, min(left + tile_width, width), samples ? min(top + tile_height, height) : top,
                   samples, pass_first + done, pass_first, pass_samples, left, top, 0};
    return queue;
}

kernel void render(SCENE_PARAMETERS, global float *slots, uint first_item, uint items, uint tile_width, uint tile_height,
                   uint chunks, uint chunk_samples, uint pass_first, uint pass_samples) {
    Scene scene = SCENE_OF_PARAMETERS;
    uint counts[TESTS_KINDS] = {0};
    scene.tests = counts;
    Queue queue = queue_of(settings, first_item + (uint)get_global_id(0), items, tile_width, tile_height, chunks, chunk_samples,
                           pass_first, pass_samples);
    Path path;
    path.ray.o = path.ray.d = path.throughput = path.radiance = path.lost = v3_all((real)(0));
    path.ray.tmin = path.ray.tmax = path.pdf = path.eta = 0;
    path.depth = path.sampler.pixel = path.sampler.sample = path.sampler.key0 = path.sampler.key1 = (uints)(0);
    path.direct = NO_LANES;
    Starts starts;
    starts.next = 0;
    starts.end = start_paths(&scene, &queue, &starts.ready);
    starts.taken = starts.ready;
    mask live = refill(&scene, &queue, &starts, &path, lanes_of(ALL_LANES));
    while (ANY(live)) {
        Hit hit = closest_hit(&scene, path.ray, live);
        if (OPAL_TWICE_traversal) hit = closest_hit(&scene, same_ray(path.ray, hit.t > -1), live);
        COUNT_TESTS(&scene, rays, count_lanes(live));
        COUNT_TESTS(&scene, rounds, 1);
        mask go_on = integrator_step(&scene, &path, hit, live);
        uint ended = lanes_of(live & !go_on);
        live = go_on;
        if (ended == 0) continue;
        retire(&scene, slots, &queue, &path, ended);
        live = live | refill(&scene, &queue, &starts, &path, ended);
    }
}

// Marks the slots of items that were not rendered (an interrupted pass) as empty.
kernel void clear(global const Settings *settings, global float *slots, uint first_item, uint items, uint tile_width,
                  uint tile_height, uint chunks, uint chunk_samples, uint pass_first, uint pass_samples) {
    Queue q = queue_of(settings, first_item + (uint)get_global_id(0), items, tile_width, tile_height, chunks, chunk_samples,
                       pass_first, pass_samples);
    for (uint y = q.top; y < q.bottom; y++)
        for (uint x = q.left; x < q.right; x++)
            for (uint s = 0; s < q.samples; s++)
                slots[3 * ((ulong)(y * settings->width + x) * pass_samples + (q.first_sample - pass_first) + s)] = as_float(SLOT_EMPTY);
}

// One sample's colour of each lane's pixel.
static v3 slot_color(global const float *slots, uints pixel, uint s, uint pass_samples) {
    global const float *sample = slots + 3 * s;
    uints word = pixel * (3 * pass_samples);
    return v3_of(GATHER(real, sample, word, ), GATHER(real, (sample + 1), word, ), GATHER(real, (sample + 2), word, ));
}

// Counts samples that are neither finite nor empty, and notes the pixel and index of the first few.
static void note_invalid(global const float *slots, FilmPlace at, mask valid, uint s, uint pass_first, uint pass_samples, volatile global uint *invalid) {
    int ok[LANES];
    STORE(to_ints(valid), ok);
    for (uint lane = 0; lane < LANES && at.first + lane < at.pixels; lane++) {
        uint pixel = at.first + lane;
        if (ok[lane] || as_uint(slots[3 * ((ulong)pixel * pass_samples + s)]) == SLOT_EMPTY) continue;
        uint record = atomic_inc(invalid);
        if (record < INVALID_RECORDS) {
            invalid[1 + 2 * record] = pixel;
            invalid[2 + 2 * record] = pass_first + s;
        }
    }
}

// The pixels' own samples, for the box filter and for statistics.
static void gather_own(FilmPlace at, global const float *slots, global float *film, global uint *counts, volatile global uint *invalid,
                uint pass_first, uint pass_samples) {
    Sum sums[3], squares[4];
    for (uint c = 0; c < 3; c++) sums[c] = film_load(film, at, FILM_SUM + c, 3);
    for (uint c = 0; c < 4; c++) squares[c] = film_load(film, at, FILM_SQUARES + c, 4);
    uints count = GATHER(uints, counts, at.pixel, );
    for (uint s = 0; s < pass_samples; s++) {
        v3 c = slot_color(slots, at.pixel, s, pass_samples);
        mask valid = is_finite(c);
        if (ANY(!valid)) note_invalid(slots, at, valid, s, pass_first, pass_samples, invalid);
        sums[0] = sum_add(sums[0], c.x, valid);
        sums[1] = sum_add(sums[1], c.y, valid);
        sums[2] = sum_add(sums[2], c.z, valid);
        squares[0] = sum_add(squares[0], c.x * c.x, valid);
        squares[1] = sum_add(squares[1], c.y * c.y, valid);
        squares[2] = sum_add(squares[2], c.z * c.z, valid);
        squares[3] = sum_add(squares[3], square(luminance(c)), valid);
        count = count + uints_pick(valid, (uints)(1), (uints)(0));
    }
    for (uint c = 0; c < 3; c++) film_store(film, at, FILM_SUM + c, 3, sums[c]);
    for (uint c = 0; c < 4; c++) film_store(film, at, FILM_SQUARES + c, 4, squares[c]);
    uint count_of[LANES];
    STORE(count, count_of);
    for (uint lane = 0; lane < LANES && at.first + lane < at.pixels; lane++) counts[at.first + lane] = count_of[lane];
}

// The samples of the pixels around, wherever in those they fell, by the filter's weight.
static void gather_around(FilmPlace at, global const Settings *settings, global const float *slots, global float *film, uint pass_first,
                   uint pass_samples) {
    Scene scene = {settings, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    uint width = settings->width, height = settings->height;
    Sum sums[4];
    for (uint c = 0; c < 4; c++) sums[c] = film_load(film, at, FILM_WEIGHTED + c, 4);
    int reach = (int)ceil(settings->filter_radius - 0.5f);
    uints x = at.pixel % width, y = at.pixel / width;
    for (uint s = 0; s < pass_samples; s++)
        for (int dy = -reach; dy <= reach; dy++)
            for (int dx = -reach; dx <= reach; dx++) {
                uints nx = x + (uint)dx, ny = y + (uint)dy; // below 0 wraps to far beyond the image
                mask inside = to_mask(nx < width) & to_mask(ny < height);
                uints pixel = uints_pick(inside, ny * width + nx, (uints)(0));
                v2 offset = film_offset(&scene, sampler_start(pixel, (uints)(pass_first + s), settings->seed));
                real w = filter_1d(settings, offset.x - R(0.5) + (real1)dx) * filter_1d(settings, offset.y - R(0.5) + (real1)dy);
                v3 c = slot_color(slots, pixel, s, pass_samples);
                mask valid = inside & is_finite(c);
                sums[0] = sum_add(sums[0], w * c.x, valid);
                sums[1] = sum_add(sums[1], w * c.y, valid);
                sums[2] = sum_add(sums[2], w * c.z, valid);
                sums[3] = sum_add(sums[3], w, valid);
            }
    for (uint c = 0; c < 4; c++) film_store(film, at, FILM_WEIGHTED + c, 4, sums[c]);
}

// Adds a pass to the film: LANES pixels a work-item, each sample after the other.
kernel void gather(global const Settings *settings, global const float *slots, global float *film, global uint *counts,
                   volatile global uint *invalid, uint pass_first, uint pass_samples) {
    FilmPlace at;
    at.pixels = settings->width * settings->height;
    at.first = (uint)get_global_id(0) * LANES;
    if (at.first >= at.pixels) return;
    uint index[LANES];
    for (uint lane = 0; lane < LANES; lane++) index[lane] = min(at.first + lane, at.pixels - 1);
    at.pixel = LOAD(uints, index);
    gather_own(at, slots, film, counts, invalid, pass_first, pass_samples);
    if (OPAL_HAS_wide_filter) gather_around(at, settings, slots, film, pass_first, pass_samples);
}
