#include "strategies/check.h"

#include "base/error.h"
#include "base/log.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

// A light that BSDF samples may hit.
bool has_hit_light(const SceneDescription &scene) {
    return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh &mesh) { return mesh.radiance; }) ||
           std::any_of(scene.lights.begin(), scene.lights.end(), [](const Light &l) { return can_be_met(l.kind()); });
}

[[noreturn]] void refuse(const std::string &combination, const std::string &reason) {
    throw Error(combination + " makes no sense: " + reason);
}

void check_numbers(const Strategy &strategy) {
    if (!(strategy.rr_prob > 0 && strategy.rr_prob <= 1))
        refuse("rr-prob " + std::to_string(strategy.rr_prob), "a probability to survive is above 0 and at most 1");
    if (strategy.max_depth < 1)
        refuse("max-depth 0", "the shortest path has one segment and shows the lights");
}

void check_mis(const Strategy &strategy) {
    if (strategy[AXIS_mis] != CHOICE_mis_one_sample)
        return;
    if (strategy[AXIS_integrator] != CHOICE_integrator_direct_lighting)
        refuse("mis one-sample without integrator direct_lighting",
               "one sample of either kind cannot be counted in and go on as a path; available: balance, power");
    if (strategy[AXIS_lighting] != CHOICE_lighting_mis)
        refuse("mis one-sample without lighting mis", "there is only one kind of sample, and nothing to choose from");
}

void check_lighting(const SceneDescription &scene) {
    const Strategy &strategy = scene.strategy;
    int integrator = strategy[AXIS_integrator];
    if (integrator == CHOICE_integrator_whitted && strategy[AXIS_lighting] != CHOICE_lighting_emitter)
        refuse("integrator whitted without lighting emitter", "it finds light by emitter sampling alone");
    bool follows = integrator == CHOICE_integrator_path || integrator == CHOICE_integrator_direct_lighting;
    const Light *missed = light_missed_by_bsdfs(scene);
    if (!follows || strategy[AXIS_lighting] != CHOICE_lighting_bsdf || !missed)
        return;
    const std::string kind = emitter_name(missed->kind());
    if (!has_hit_light(scene))
        refuse(fmt::format("lighting bsdf with {} lights only", kind),
               fmt::format("no BSDF sample can hit a {} light; available: emitter, mis", kind));
    warn(fmt::format("{}: lighting bsdf cannot hit {} lights: their light is missing", missed->place.text(), kind));
}

} // namespace

void check_strategy(const SceneDescription &scene) {
    const Strategy &strategy = scene.strategy;
    int integrator = strategy[AXIS_integrator];
    check_numbers(strategy);
    check_mis(strategy);
    check_lighting(scene);
    if (integrator == CHOICE_integrator_ao && strategy[AXIS_hemisphere] == CHOICE_hemisphere_material)
        refuse("integrator ao with hemisphere material", "it asks no material; available: uniform, cosine");
    if (integrator == CHOICE_integrator_simple && scene.simple_light.energy == Color{})
        refuse("integrator simple", "the scene gives it no light: its integrator has no 'position' and 'energy'");
    if (integrator == CHOICE_integrator_path && strategy[AXIS_rr] == CHOICE_rr_off && strategy.max_depth == no_limit)
        warn("rr off and no max-depth: a path ends only where it leaves the scene or carries nothing");
}

} // namespace opal
