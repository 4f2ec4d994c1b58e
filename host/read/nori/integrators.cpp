// Parsers of integrators: the properties of both dialects become choices of the strategy's axes.
#include "read/nori/parsers.h"
#include "scene/options.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

void parse_normals(Properties &properties, SceneDescription &scene) {
    scene.normals_signed = properties.boolean("signed").value_or(false);
}

void parse_ao(Properties &properties, SceneDescription &scene) {
    bool cosine = properties.boolean("cosine_sampling").value_or(true);
    scene.strategy[AXIS_hemisphere] = cosine ? CHOICE_hemisphere_cosine : CHOICE_hemisphere_uniform;
}

void parse_av(Properties &properties, SceneDescription &scene) {
    scene.visibility_length = properties.required(properties.number("length"), "length");
    properties.check(scene.visibility_length > 0, "length", "must be above 0: how far it looks");
}

void parse_simple(Properties &properties, SceneDescription &scene) {
    const auto position = properties.point("position");
    const auto energy_given = properties.color("energy");
    scene.simple_light = {properties.required(position, "position"), properties.required(energy_given, "energy")};
    const Color &energy = scene.simple_light.energy;
    properties.check(*std::min_element(energy.begin(), energy.end()) >= 0, "energy", "must not be negative");
}

void parse_direct_lighting(Properties &properties, SceneDescription &scene) {
    bool surface = properties.boolean("surface_sampling").value_or(false);
    bool mis = properties.boolean("mis_sampling").value_or(false);
    Strategy &strategy = scene.strategy;
    strategy[AXIS_lighting] = mis ? CHOICE_lighting_mis : surface ? CHOICE_lighting_emitter : CHOICE_lighting_bsdf;
    if (mis)
        strategy[AXIS_mis] = CHOICE_mis_one_sample;
}

// rr and mis are booleans in this dialect, and strings as Opal's axes. Both are read.
void parse_path_tracer_recursive(Properties &properties, SceneDescription &scene) {
    bool nee = properties.boolean("nee").value_or(false), mis = properties.boolean_if("mis").value_or(false);
    bool rr = properties.boolean_if("rr").value_or(false);
    bool fixed = properties.number("rr_prob").has_value();
    bool dynamic = properties.boolean("rr_dynamic").value_or(!fixed); // written by the course's exporter
    properties.ignore("iterative");                                   // a choice of implementation
    Strategy &strategy = scene.strategy;
    strategy[AXIS_lighting] = mis ? CHOICE_lighting_mis : nee ? CHOICE_lighting_emitter : CHOICE_lighting_bsdf;
    strategy[AXIS_rr] = !rr ? CHOICE_rr_off : fixed && !dynamic ? CHOICE_rr_fixed : CHOICE_rr_throughput_eta;
}

struct Parser {
    std::string name;
    void (*parse)(Properties &, SceneDescription &);
};

// Integrators with properties of their own.
const std::vector<Parser> parsers = {{"normals", parse_normals},
                                     {"ao", parse_ao},
                                     {"av", parse_av},
                                     {"simple", parse_simple},
                                     {"direct_lighting", parse_direct_lighting},
                                     {"path_tracer_recursive", parse_path_tracer_recursive}};

// Every option of the strategy can be given as a property, which then decides.
void parse_options(Properties &properties, Strategy &strategy) {
    for (const StrategyOption &option : strategy_options())
        if (auto value = properties.text(option.xml_tag, option.xml_name))
            try {
                set_option(strategy, option.name, *value);
            } catch (const Error &error) {
                properties.mistake_at(option.xml_name, error.what());
            }
}

} // namespace

void parse_integrator(const XmlNode &node, const ParseContext &context, SceneDescription &scene) {
    Properties properties(node, context);
    const IntegratorType *type =
        properties.row_of_type(integrator_types(), fmt::format("{} stands in for it", scene.integrator_type));
    if (!type)
        type = &find_integrator(scene.integrator_type);
    scene.integrator_type = type->name;
    apply_integrator(scene.strategy, *type);
    for (const Parser &parser : parsers)
        if (parser.name == type->name)
            context.attempt(node, [&] { parser.parse(properties, scene); });
    parse_options(properties, scene.strategy);
    if (integrator_of(scene.strategy).has(OPAL_ASKS_LIGHTS))
        scene.hides_emitters = properties.boolean("hide_emitters").value_or(false);
    properties.finish();
}

} // namespace opal
