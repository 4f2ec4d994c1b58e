// choice: which emitter light sampling asks, and with which probability.
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/alias_table.cl"
#include "scene.cl"

// Chooses an emitter a lane by two random words (--emitter-choice).
static uints emitter_choose(const Scene *scene, u2 u) {
    uints id = (uints)(0);
    if (OPAL_HAS_many_emitters) ALIAS_ENTRY(scene, emitters, (uints)(0), (uints)(scene->settings->emitter_count), u, id)
    return id;
}

// The probability with which emitter_choose returns `id`.
static real emitter_probability(const Scene *scene, uints id) {
    return OPAL_HAS_many_emitters ? GATHER(real, scene->emitters, id, .probability) : (real)(1);
}
