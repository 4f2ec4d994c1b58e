#include "scene/options.h"

#include "base/table.h"
#include "base/values.h"

#include <algorithm>

namespace opal {

namespace {

std::string with(std::string name, char from, char to) {
    std::replace(name.begin(), name.end(), from, to);
    return name;
}

unsigned parse_count(const std::string &value, const char *what) {
    int number = parse_integer(value);
    if (number < 1)
        throw Error(std::string(what) + " must be at least 1, not " + value);
    return static_cast<unsigned>(number);
}

// -1 is what other renderers' scenes write for "none".
void set_max_depth(Strategy &strategy, const std::string &value) {
    strategy.max_depth =
        value == "none" || value == "-1" ? no_limit : parse_count(value, "max-depth ('none' for no limit)");
}

void set_rr_depth(Strategy &strategy, const std::string &value) { strategy.rr_depth = parse_count(value, "rr-depth"); }

void set_rr_prob(Strategy &strategy, const std::string &value) {
    double probability = parse_number(value);
    if (!(probability > 0 && probability <= 1))
        throw Error("rr-prob must be a probability to survive, above 0 and at most 1, not " + value);
    strategy.rr_prob = probability;
}

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

void set_specialise(Strategy &strategy, const std::string &value) {
    struct Row {
        std::string name;
        bool on;
    };
    static const std::vector<Row> switches = {{"on", true}, {"off", false}};
    bool is_boolean = std::tolower(value[0]) == 't' || std::tolower(value[0]) == 'f'; // the XML's spelling
    strategy.specialise = is_boolean ? parse_boolean(value) : find_row(switches, "specialise", value).on;
}

struct Number : Option {
    void (*set)(Strategy &, const std::string &);
};

const std::vector<Number> numbers = {
    {{"max-depth", "maxDepth", "integer"}, set_max_depth},
    {{"rr-depth", "rrDepth", "integer"}, set_rr_depth},
    {{"rr-prob", "rr_prob", "float"}, set_rr_prob},
    {{"math", "math", "string"}, set_math},
    {{"lanes", "lanes", "integer"}, set_lanes},
    {{"specialise", "specialise", "boolean"}, set_specialise},
};

constexpr bool university = true;

// The nine names of the two dialects, and `path` for a path tracer whose lighting is a property.
const std::vector<IntegratorType> types = {
    {"normals", CHOICE_integrator_normals},
    {"ao", CHOICE_integrator_ao},
    {"simple", CHOICE_integrator_simple},
    {"whitted", CHOICE_integrator_whitted, !university, CHOICE_lighting_emitter, CHOICE_rr_fixed},
    {"direct_lighting", CHOICE_integrator_direct_lighting, university},
    {"path_tracer_recursive", CHOICE_integrator_path, university},
    {"path_mats", CHOICE_integrator_path, !university, CHOICE_lighting_bsdf, CHOICE_rr_throughput_eta},
    {"path_ems", CHOICE_integrator_path, !university, CHOICE_lighting_emitter, CHOICE_rr_throughput_eta},
    {"path_mis", CHOICE_integrator_path, !university, CHOICE_lighting_mis, CHOICE_rr_throughput_eta},
    {"path", CHOICE_integrator_path},
};

int axis_named(const std::string &name) {
    for (int axis = 0; axis < AXIS_COUNT; ++axis)
        if (axes()[axis].name == name)
            return axis;
    return -1;
}

} // namespace

std::span<const Option> options() {
    static const std::vector<Option> all = [] {
        std::vector<Option> list;
        for (const Axis &axis : axes())
            if (&axis != &axes()[AXIS_integrator])
                list.push_back({axis.name, with(axis.name, '-', '_'), "string"});
        list.insert(list.end(), numbers.begin(), numbers.end());
        return list;
    }();
    return all;
}

void set_option(Strategy &strategy, const std::string &name, const std::string &value) {
    std::string typed = with(name, '_', '-');
    int axis = axis_named(typed);
    if (axis == AXIS_integrator)
        return apply_integrator(strategy, find_integrator(value));
    if (axis >= 0) {
        strategy[axis] = find_choice(axis, value);
        return;
    }
    for (const Number &number : numbers)
        if (number.name == typed)
            return number.set(strategy, value);
    std::vector<std::string> known = names_of(options());
    known.insert(known.begin(), "integrator");
    throw Error(unknown_name("strategy option", name, known));
}

std::span<const IntegratorType> integrator_types() { return types; }

const IntegratorType &find_integrator(const std::string &name) {
    return find_row(types, "integrator", with(name, '-', '_'));
}

void apply_integrator(Strategy &strategy, const IntegratorType &type) {
    strategy[AXIS_integrator] = type.integrator;
    if (type.lighting >= 0)
        strategy[AXIS_lighting] = type.lighting;
    if (type.rr >= 0)
        strategy[AXIS_rr] = type.rr;
}

// The integrator first, since its name decides other axes that may be given too. A choice of the scene's that an
// override left without a meaning falls back to the default.
void override_strategy(Strategy &strategy, const std::map<std::string, std::string> &overrides) {
    auto given = [&](const char *name) { return overrides.contains(name); };
    if (auto integrator = overrides.find("integrator"); integrator != overrides.end())
        set_option(strategy, "integrator", integrator->second);
    for (const auto &[name, value] : overrides)
        if (name != "integrator")
            set_option(strategy, name, value);
    bool one_sample_means_something = strategy[AXIS_integrator] == CHOICE_integrator_direct_lighting &&
                                      strategy[AXIS_lighting] == CHOICE_lighting_mis;
    if (strategy[AXIS_mis] == CHOICE_mis_one_sample && !one_sample_means_something && !given("mis"))
        strategy[AXIS_mis] = CHOICE_mis_balance;
    if (strategy[AXIS_integrator] == CHOICE_integrator_ao && strategy[AXIS_hemisphere] == CHOICE_hemisphere_material &&
        !given("hemisphere"))
        strategy[AXIS_hemisphere] = CHOICE_hemisphere_cosine;
}

} // namespace opal
