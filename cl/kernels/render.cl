// render: the megakernel. A work-item carries LANES paths of its own tile of pixels; a path that ends is replaced in
// place by the next sample of the tile's queue, so that lanes stay full.
#include "core/lanes.cl"
#include "integrators/dispatch.cl"
#include "integrators/steps.cl"
#include "kernels/queue.cl"
#include "kernels/retire.cl"
#include "kernels/unfinished.cl"
#include "scene.cl"
#include "shared/counters.h"
#include "shared/types.h"
#include "trace/trace.cl"
#if LANES == 1
#include "kernels/one_lane/path_starts.cl"
#else
#include "kernels/many_lanes/path_starts.cl"
#endif

// Where paths may be endless, a launch ends after most_rounds rounds. Its work-items then lie in `unfinished`, and
// *any_unfinished is set. A launch that goes on with them has `again`. A launch of 0 rounds sets *any_unfinished to the
// bytes of a work-item there.
kernel void render(SCENE_PARAMETERS, global float *samples, uint first_item, uint items, uint tile_width,
                   uint tile_height, uint chunks, uint chunk_samples, uint pass_first, uint pass_samples,
                   global Unfinished *unfinished, global uint *any_unfinished, uint most_rounds, uint again) {
    if (OPAL_HAS_endless_paths && most_rounds == 0) {
        *any_unfinished = sizeof(Unfinished);
        return;
    }
    Scene scene = SCENE_OF_PARAMETERS;
    uint counters[COUNTERS] = {0};
    scene.counters = counters;
    Path path;
    path.ray.o = path.ray.d = path.throughput = path.radiance = path.lost = v3_all((real)(0));
    path.from.p = path.from.n = v3_all((real)(0));
    path.ray.tmin = path.ray.tmax = path.pdf = path.eta = 0;
    path.depth = path.sampler.pixel = path.sampler.sample = path.sampler.key0 = path.sampler.key1 = (uints)(0);
    path.specular = path.straight = NO_LANES;
    path.first_ray = path.ray;
    path.first_hit = no_hit((real)(0));
    Queue queue = queue_of(settings, first_item + (uint)get_global_id(0), items, tile_width, tile_height, chunks,
                           chunk_samples, pass_first, pass_samples);
    Starts starts;
    prepare_starts(&scene, queue, &starts);
    // Paths start in one place, as their code is long. The loop has its only exit at its end: NVIDIA's compiler makes
    // it 1.6 times as fast (cbox_mis, H200) as one with a break.
    mask active = NO_LANES;
    uint ended = lanes_of(ALL_LANES); // the lanes whose path has ended, a bit each
    uint rounds = 0;
    if (OPAL_HAS_endless_paths && again)
        active = take_up(unfinished + get_global_id(0), &scene, &path, &starts, &ended);
    do {
        if (ended) active = active | refill(&scene, &starts, &path, ended);
        ended = 0;
        if (ANY(active)) {
            mask last = on_last_ray(&scene, &path);
            Hit hit = closest_hit(&scene, path.ray, active, last);
            if (OPAL_REPEAT_traversal) hit = closest_hit(&scene, same_ray(path.ray, hit.t > -1), active, last);
            add_count(&scene, COUNTER_rays, count_lanes(active));
            hit = pass_hidden_emitters(&scene, &path, hit, active);
            add_count(&scene, COUNTER_rounds, 1);
            mask active_next = integrator_step(&scene, &path, hit, active);
            ended = lanes_of(active & !active_next);
            active = active_next;
            if (ended) retire(&scene, samples, &starts.queue, &path, ended);
        }
        if (OPAL_HAS_endless_paths) rounds++;
    } while ((!OPAL_HAS_endless_paths || rounds < most_rounds) && (ended || ANY(active)));
    if (OPAL_HAS_endless_paths) {
        if (ended || ANY(active)) *any_unfinished = 1;
        keep(unfinished + get_global_id(0), &scene, &path, &starts, active, ended);
    }
}
