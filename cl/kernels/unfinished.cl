// unfinished: where paths may be endless, a launch ends before its work-items do, and the next one goes on with them.
#include "core/lanes.cl"
#include "integrators/steps.cl"
#include "scene.cl"
#include "shared/counters.h"
#if LANES == 1
#include "kernels/one_lane/path_starts.cl"
#else
#include "kernels/many_lanes/path_starts.cl"
#endif

// The state of a work-item between two launches.
typedef struct {
    Path path;
    Starts starts;
    uint active, ended; // lanes, a bit each
    uint counters[COUNTERS];
} Unfinished;

static void keep(global Unfinished *item, const Scene *scene, const Path *path, const Starts *starts, mask active,
                 uint ended) {
    item->path = *path;
    item->starts = *starts;
    item->active = lanes_of(active);
    item->ended = ended;
    for (uint k = 0; k < COUNTERS; k++) item->counters[k] = scene->counters[k];
}

// Returns the active lanes, and sets the ended ones.
static mask take_up(global const Unfinished *item, const Scene *scene, Path *path, Starts *starts, uint *ended) {
    *path = item->path;
    *starts = item->starts;
    *ended = item->ended;
    for (uint k = 0; k < COUNTERS; k++) scene->counters[k] = item->counters[k];
    return mask_of(item->active);
}
