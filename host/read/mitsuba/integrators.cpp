// Parsers of integrators: they become choices of the strategy's axes.
#include "base/log.h"
#include "read/mitsuba/parsers.h"
#include "scene/options.h"

#include <fmt/format.h>

namespace opal::mitsuba {

namespace {

void parse_path(Importer &, Object &object, SceneDescription &scene) {
    Strategy &strategy = scene.strategy;
    if (const auto depth = object.integer("max_depth")) {
        object.check(*depth != 0, "max_depth", "0 would be a black image; 1 shows lights, 2 adds direct light");
        object.check(*depth >= -1, "max_depth", "must be at least 1, or -1: no limit");
        strategy.max_depth = *depth < 1 ? no_limit : unsigned(*depth);
    }
    const int rr_depth = object.integer("rr_depth").value_or(int(strategy.rr_depth));
    object.check(rr_depth >= 1, "rr_depth", "must be at least 1");
    strategy.rr_depth = unsigned(std::max(rr_depth, 1));
}

// How many samples of a kind; 0 of one kind leaves the other alone.
int parse_count(Object &object, const char *name, int otherwise) {
    const int count = object.integer(name).value_or(otherwise);
    object.check(count >= 0, name, "must not be negative");
    return std::max(count, 0);
}

void parse_direct(Importer &, Object &object, SceneDescription &scene) {
    Strategy &strategy = scene.strategy;
    const char *const both = "shading_samples";
    const int shading = parse_count(object, both, 1);
    const int emitter = parse_count(object, "emitter_samples", shading);
    const int bsdf = parse_count(object, "bsdf_samples", shading);
    if (object.has(both) && (object.has("emitter_samples") || object.has("bsdf_samples")))
        object.mistake_at(both, "stands beside emitter_samples or bsdf_samples, which say it, too");
    if (emitter == 0 && bsdf == 0)
        object.mistake("emitter_samples and bsdf_samples are both 0: nothing finds light");
    scene.integrator_type = "direct_lighting";
    strategy[AXIS_integrator] = CHOICE_integrator_direct_lighting;
    strategy[AXIS_lighting] = bsdf == 0      ? CHOICE_lighting_emitter
                              : emitter == 0 ? CHOICE_lighting_bsdf
                                             : CHOICE_lighting_mis;
    strategy.emitter_samples = unsigned(std::max(emitter, 1));
    strategy.bsdf_samples = unsigned(std::max(bsdf, 1));
}

// An integrator around another one, which renders.
void parse_inner(Importer &importer, Object &object, SceneDescription &scene) {
    if (const auto inner = only_child(object, "integrator"))
        parse_integrator(importer, *inner, scene);
    else
        object.mistake(fmt::format("{} holds no <integrator> that renders", object.type()));
}

void parse_moment(Importer &importer, Object &object, SceneDescription &scene) {
    scene.wants_variance = true;
    parse_inner(importer, object, scene);
}

void parse_aov(Importer &importer, Object &object, SceneDescription &scene) {
    const std::string channels = object.string("aovs").value_or("");
    if (!object.has("aovs"))
        object.mistake("aov lacks its property 'aovs'");
    else
        warn(fmt::format("{}: Opal writes none of these channels: {}", object.place_of("aovs").text(), channels));
    parse_inner(importer, object, scene);
}

const std::vector<Plugin<void (*)(Importer &, Object &, SceneDescription &)>> integrator_types = {
    {"path", "path", parse_path},
    {"volpath", "path", parse_path}, // it is the same where there are no media
    {"volpathmis", "path", parse_path},
    {"direct", "direct_lighting", parse_direct},
    {"moment", "the integrator within it", parse_moment},
    {"aov", "the integrator within it", parse_aov},
};

} // namespace

void set_default_strategy(SceneDescription &scene) {
    constexpr double most_survival = 0.95; // of Mitsuba's roulette
    constexpr unsigned first_roulette = 5;
    scene.integrator_type = "path";
    scene.lights_reflect = true; // under `direct`, too
    Strategy &strategy = scene.strategy;
    strategy[AXIS_integrator] = CHOICE_integrator_path;
    strategy[AXIS_lighting] = CHOICE_lighting_mis;
    strategy[AXIS_mis] = CHOICE_mis_power;
    strategy[AXIS_hemisphere] = CHOICE_hemisphere_cosine;
    strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
    strategy[AXIS_rr] = CHOICE_rr_throughput_eta;
    strategy.rr_max = most_survival;
    strategy.rr_depth = first_roulette;
}

void parse_integrator(Importer &importer, Object &object, SceneDescription &scene) {
    const auto *type = importer.row_of_type(object, integrator_types, "path stands in for it");
    if (!type)
        return;
    scene.hides_emitters = object.boolean("hide_emitters").value_or(false); // the inner one's is read last, and counts
    for (const char *name : {"block_size", "samples_per_pass"})             // how work is shared out
        object.ignore(name);
    if (object.number("timeout").value_or(0) > 0)
        note(fmt::format("{}: timeout: Opal renders all samples; --time sets a limit",
                         object.place_of("timeout").text()));
    type->parse(importer, object, scene);
    object.finish();
}

} // namespace opal::mitsuba
