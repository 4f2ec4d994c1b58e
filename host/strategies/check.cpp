#include "strategies/check.h"

#include "base/error.h"
#include "base/log.h"
#include "base/table.h"

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
    if (!(strategy.rr_max > 0 && strategy.rr_max <= 1))
        refuse(fmt::format("rr-max {}", strategy.rr_max), "a probability to survive is above 0 and at most 1");
    constexpr unsigned most_samples = 65536; // of a path: it ends after them, however long a user waits
    for (const auto &[name, samples] :
         {std::pair("emitter-samples", strategy.emitter_samples), std::pair("bsdf-samples", strategy.bsdf_samples)})
        if (samples > most_samples)
            refuse(fmt::format("{} {}", name, samples), fmt::format("a path takes at most {}", most_samples));
    if (strategy.max_depth < 1)
        refuse("max-depth 0", "the shortest path has one segment and shows the lights");
}

// The integrators that have a trait: "a" or "a or b".
std::string names_of_integrators(unsigned trait) {
    std::vector<std::string> names;
    for (const IntegratorTraits &integrator : integrators())
        if (integrator.has(trait))
            names.push_back(integrator.name);
    return fmt::format("{}", fmt::join(names, " or "));
}

void check_mis(const Strategy &strategy) {
    if (strategy[AXIS_mis] != CHOICE_mis_one_sample)
        return;
    std::vector<std::string> others = names_of(axes()[AXIS_mis].choices);
    others.erase(others.begin() + CHOICE_mis_one_sample);
    if (!integrator_of(strategy).has(OPAL_ONE_SAMPLE_MIS))
        refuse("mis one-sample without integrator " + names_of_integrators(OPAL_ONE_SAMPLE_MIS),
               "one sample of either kind cannot be counted in and go on as a path; available: " + joined(others));
    if (!can_take_one_sample(strategy))
        refuse("mis one-sample without lighting mis", "there is only one kind of sample, and nothing to choose from");
    if (strategy.emitter_samples > 1 || strategy.bsdf_samples > 1)
        refuse(fmt::format("mis one-sample with emitter-samples {} and bsdf-samples {}", strategy.emitter_samples,
                           strategy.bsdf_samples),
               "it takes one sample of either kind; available: " + joined(others));
}

void check_lighting(const SceneDescription &scene) {
    const Strategy &strategy = scene.strategy;
    const IntegratorTraits &integrator = integrator_of(strategy);
    if (!integrator.has(OPAL_ASKS_LIGHTS))
        return;
    if (!integrator.reads(AXIS_lighting) && strategy[AXIS_lighting] != CHOICE_lighting_emitter)
        refuse(fmt::format("integrator {} without lighting emitter", integrator.name),
               "it finds light by emitter sampling alone");
    const Light *missed = light_missed_by_bsdfs(scene);
    if (samples_emitters(strategy) || !missed)
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
    const IntegratorTraits &integrator = integrator_of(strategy);
    check_numbers(strategy);
    check_mis(strategy);
    check_lighting(scene);
    if (!has_hemisphere(strategy))
        refuse(fmt::format("integrator {} with hemisphere material", integrator.name),
               "it asks no material; available: uniform, cosine");
    if (integrator.has(OPAL_ASKS_OWN_LIGHT) && scene.simple_light.energy == Color{})
        refuse(fmt::format("integrator {}", integrator.name),
               "the scene gives it no light: its integrator has no 'position' and 'energy'");
    if (integrator.reads(AXIS_rr) && strategy[AXIS_rr] == CHOICE_rr_off && strategy.max_depth == no_limit)
        warn("rr off and no max-depth: a path ends only where it leaves the scene or carries nothing");
}

} // namespace opal
