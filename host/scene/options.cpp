#include "scene/options.h"

#include "base/table.h"
#include "base/values.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

std::string replaced(std::string name, char from, char to) {
    std::replace(name.begin(), name.end(), from, to);
    return name;
}

unsigned parse_count(const std::string &value, const char *what) {
    int number = parse_integer(value);
    if (number < 1)
        throw Error(std::string(what) + " must be at least 1, not " + value);
    return static_cast<unsigned>(number);
}

// Scenes of other renderers write -1 for "none".
void set_max_depth(Strategy &strategy, const std::string &value) {
    strategy.max_depth =
        value == "none" || value == "-1" ? no_limit : parse_count(value, "max-depth ('none' for no limit)");
}

void set_rr_depth(Strategy &strategy, const std::string &value) { strategy.rr_depth = parse_count(value, "rr-depth"); }

double parse_survival(const std::string &value, const char *what) {
    const double probability = parse_number(value);
    if (!(probability > 0 && probability <= 1))
        throw Error(fmt::format("{} must be a probability to survive, above 0 and at most 1, not {}", what, value));
    return probability;
}

void set_rr_prob(Strategy &strategy, const std::string &value) { strategy.rr_prob = parse_survival(value, "rr-prob"); }

void set_rr_max(Strategy &strategy, const std::string &value) { strategy.rr_max = parse_survival(value, "rr-max"); }

void set_math(Strategy &strategy, const std::string &value) {
    const MathModeRow &row = find_row(math_modes(), "math", value);
    strategy.math = static_cast<MathMode>(&row - math_modes().data());
}

void set_lanes(Strategy &strategy, const std::string &value) {
    struct Row {
        std::string name;
        int lanes;
    };
    static const std::vector<Row> widths = {{"auto", 0}, {"1", 1}, {"4", 4}, {"8", 8}, {"16", 16}};
    strategy.lanes = find_row(widths, "lanes", value == "0" ? "auto" : value).lanes;
}

struct SpecialiseRow {
    std::string name;
    Specialise value;
};
const std::vector<SpecialiseRow> specialise_rows = { // by Specialise
    {"auto", Specialise::automatic},
    {"on", Specialise::on},
    {"off", Specialise::off}};

void set_specialise(Strategy &strategy, const std::string &value) {
    const bool is_boolean =
        std::tolower(value[0]) == 't' || std::tolower(value[0]) == 'f'; // "true" or "false", as the XML has it
    strategy.specialise = is_boolean ? parse_boolean(value) ? Specialise::on : Specialise::off
                                     : find_row(specialise_rows, "specialise", value).value;
}

const std::vector<StrategyOption> numbers = {
    {"max-depth",
     "maxDepth",
     "integer",
     "N|none",
     "segments of the longest path: 1 shows lights, 2 adds direct light [the scene's, else none]",
     set_max_depth,
     [](const Strategy &s) { return s.max_depth == no_limit ? "none" : std::to_string(s.max_depth); },
     {"none"}},
    {"rr-depth", "rrDepth", "integer", "N", "Russian roulette from this many segments on [the scene's, else 3]",
     set_rr_depth, [](const Strategy &s) { return std::to_string(s.rr_depth); }},
    {"rr-prob", "rr_prob", "float", "P", "--rr fixed: probability to survive, above 0 to 1 [the scene's, else 0.95]",
     set_rr_prob, [](const Strategy &s) { return fmt::format("{}", s.rr_prob); }},
    {"rr-max", "rr_max", "float", "P",
     "--rr throughput, throughput-eta: greatest probability to survive, above 0 to 1 [the scene's, else 0.9999]",
     set_rr_max, [](const Strategy &s) { return fmt::format("{}", s.rr_max); }},
    {"emitter-samples", "emitter_samples", "integer", "N",
     "direct_lighting: light samples of the first surface [the scene's, else 1]",
     [](Strategy &s, const std::string &value) { s.emitter_samples = parse_count(value, "emitter-samples"); },
     [](const Strategy &s) { return std::to_string(s.emitter_samples); }},
    {"bsdf-samples", "bsdf_samples", "integer", "N",
     "direct_lighting: BSDF samples of the first surface [the scene's, else 1]",
     [](Strategy &s, const std::string &value) { s.bsdf_samples = parse_count(value, "bsdf-samples"); },
     [](const Strategy &s) { return std::to_string(s.bsdf_samples); }},
    {"math", "math", "string", "MODE",
     "precise: single precision; fast: the same with relaxed math; double: double precision, where the device has it "
     "[precise]",
     set_math, [](const Strategy &s) { return name_of(s.math); }, names_of(math_modes())},
    {"lanes",
     "lanes",
     "integer",
     "N|auto",
     "paths that a work-item carries: 1, 4, 8, 16, or auto: what the device's vectors hold, 1 on a GPU [auto]",
     set_lanes,
     [](const Strategy &s) { return s.lanes ? std::to_string(s.lanes) : "auto"; },
     {"auto", "1", "4", "8", "16"}},
    {"specialise", "specialise", "boolean", "auto|on|off",
     "on: compile a kernel for what the scene needs; off: the general kernel, which is compiled once for all scenes; "
     "auto: off on a CPU for few paths (fewer than 2^25, pixels times samples), else on [auto]",
     set_specialise, [](const Strategy &s) { return specialise_rows[size_t(s.specialise)].name; },
     names_of(specialise_rows)},
};

StrategyOption option_of_axis(int axis) {
    const Axis &row = axes()[axis];
    std::string help = fmt::format("{} [the scene's, else {}]", row.help, row.choices[0].name);
    for (const Choice &choice : row.choices)
        help += fmt::format("\n  {}: {}", choice.name, choice.help);
    return {row.name,
            replaced(row.name, '-', '_'),
            "string",
            "NAME",
            help,
            [axis](Strategy &s, const std::string &value) { s[axis] = find_choice(axis, value); },
            [axis](const Strategy &s) { return axes()[axis].choices[s[axis]].name; },
            names_of(row.choices)};
}

// Names of the dialects that imply choices, or differ from the integrator's own. An integrator that is not here has its
// own name.
const std::vector<IntegratorType> dialect_types = {
    {"whitted", CHOICE_integrator_whitted, CHOICE_lighting_emitter, CHOICE_rr_fixed},
    {"direct_lighting", CHOICE_integrator_direct_lighting},
    {"path_tracer_recursive", CHOICE_integrator_path},
    {"path_mats", CHOICE_integrator_path, CHOICE_lighting_bsdf, CHOICE_rr_throughput_eta},
    {"path_ems", CHOICE_integrator_path, CHOICE_lighting_emitter, CHOICE_rr_throughput_eta},
    {"path_mis", CHOICE_integrator_path, CHOICE_lighting_mis, CHOICE_rr_throughput_eta},
};

// Further names, which are listed last. direct_mats and so on are those of ETH's and Zaragoza's courses, by what public
// forks compute: direct and direct_whitted sample every light once, direct_ems one of them, which is one expectation.
// mipath is the path_mis of 2012.
const std::vector<IntegratorType> other_types = {
    {"direct", CHOICE_integrator_direct_lighting, CHOICE_lighting_emitter},
    {"direct_ems", CHOICE_integrator_direct_lighting, CHOICE_lighting_emitter},
    {"direct_mats", CHOICE_integrator_direct_lighting, CHOICE_lighting_bsdf},
    {"direct_mis", CHOICE_integrator_direct_lighting, CHOICE_lighting_mis},
    {"direct_whitted", CHOICE_integrator_direct_lighting, CHOICE_lighting_emitter},
    {"mipath", CHOICE_integrator_path, CHOICE_lighting_mis, CHOICE_rr_throughput_eta},
};

std::vector<IntegratorType> all_types() {
    std::vector<IntegratorType> types;
    for (size_t i = 0; i < integrators().size(); i++) {
        const IntegratorType own{integrators()[i].name, int(i)};
        bool named = false;
        for (const IntegratorType &type : dialect_types)
            if (type.integrator == own.integrator) {
                types.push_back(type);
                named = named || type.name == own.name;
            }
        if (!named)
            types.push_back(own);
    }
    types.insert(types.end(), other_types.begin(), other_types.end());
    return types;
}

} // namespace

std::span<const StrategyOption> strategy_options() {
    static const std::vector<StrategyOption> all = [] {
        std::vector<StrategyOption> list;
        for (int axis = 0; axis < AXIS_COUNT; axis++)
            if (axis != AXIS_integrator)
                list.push_back(option_of_axis(axis));
        list.insert(list.end(), numbers.begin(), numbers.end());
        return list;
    }();
    return all;
}

void set_option(Strategy &strategy, const std::string &name, const std::string &value) {
    const std::string typed = with_hyphens(name);
    if (typed == "integrator")
        return apply_integrator(strategy, find_integrator(value));
    for (const StrategyOption &option : strategy_options())
        if (option.name == typed)
            return option.set(strategy, value);
    std::vector<std::string> known = names_of(strategy_options());
    known.insert(known.begin(), "integrator");
    throw Error(unknown_name("strategy option", name, known));
}

std::span<const IntegratorType> integrator_types() {
    static const std::vector<IntegratorType> types = all_types();
    return types;
}

const IntegratorType &find_integrator(const std::string &name) {
    return find_row(integrator_types(), "integrator", replaced(name, '-', '_'));
}

std::string integrator_name(const SceneDescription &scene) {
    const int chosen = scene.strategy[AXIS_integrator];
    return find_integrator(scene.integrator_type).integrator == chosen ? scene.integrator_type
                                                                       : axes()[AXIS_integrator].choices[chosen].name;
}

void apply_integrator(Strategy &strategy, const IntegratorType &type) {
    strategy[AXIS_integrator] = type.integrator;
    if (type.lighting >= 0)
        strategy[AXIS_lighting] = type.lighting;
    if (type.rr >= 0)
        strategy[AXIS_rr] = type.rr;
}

// The integrator comes first, as its name implies choices of other axes, which may be overridden too. Where an override
// leaves one of the scene's choices without meaning, that choice falls back to its default.
void override_strategy(Strategy &strategy, const std::map<std::string, std::string> &overrides) {
    auto given = [&](const char *name) { return overrides.contains(name); };
    if (auto integrator = overrides.find("integrator"); integrator != overrides.end())
        set_option(strategy, "integrator", integrator->second);
    for (const auto &[name, value] : overrides)
        if (name != "integrator")
            set_option(strategy, name, value);
    if (strategy[AXIS_mis] == CHOICE_mis_one_sample && !can_take_one_sample(strategy) && !given("mis"))
        strategy[AXIS_mis] = CHOICE_mis_balance;
    if (!has_hemisphere(strategy) && !given("hemisphere"))
        strategy[AXIS_hemisphere] = CHOICE_hemisphere_cosine;
}

} // namespace opal
