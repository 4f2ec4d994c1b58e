// choice: which emitter light sampling asks, and with which probability.
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/alias_table.cl"
#include "emitters/interface.cl"
#include "scene.cl"

typedef struct {
    uints id;
    real probability; // with which it is chosen, exactly
} EmitterChoice;

// The probability with which emitter_choose returns `id`.
static real emitter_probability(const Scene *scene, uints id, ReferencePoint from) {
    return OPAL_HAS_many_emitters ? GATHER(real, scene->emitters, id, .probability) : (real)(1);
}

// Chooses an emitter a lane as the light of `from`, by two random words (--emitter-choice).
static EmitterChoice emitter_choose(const Scene *scene, ReferencePoint from, u2 bits) {
    EmitterChoice choice = {(uints)(0), (real)(1)};
    if (!OPAL_HAS_many_emitters) return choice;
    ALIAS_ENTRY(scene, emitters, (uints)(0), (uints)(scene->settings->emitter_count), bits, choice.id)
    choice.probability = emitter_probability(scene, choice.id, from);
    return choice;
}
