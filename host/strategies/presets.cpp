#include "strategies/presets.h"

#include "base/error.h"
#include "base/table.h"
#include "scene/options.h"
#include "strategies/combinations.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

struct PresetRow {
    std::string name; // as in Candidate
    const char *label;
    bool only_all; // not in `course`
};

// Each is for the integrators that read its axes.
const std::vector<PresetRow> preset_rows = {
    {"lighting=bsdf,hemisphere=uniform", "uniform hemisphere", false},
    {"lighting=bsdf,hemisphere=cosine", "cosine hemisphere", false},
    {"lighting=emitter", "emitter sampling (NEE)", false},
    {"lighting=mis,mis=one-sample", "MIS, one sample", false},
    {"lighting=mis,mis=balance", "MIS, balance heuristic", false},
    {"lighting=mis,mis=power", "MIS, power heuristic", false},
    {"lighting=mis,mis=power,emitter-choice=uniform", "MIS, power; emitters alike", true},
    {"lighting=mis,mis=power,sampler=stratified", "MIS, power; stratified", true},
    {"lighting=mis,mis=power,sampler=sobol", "MIS, power; Sobol", true},
    {"lighting=mis,mis=power,rr=throughput", "MIS, power; roulette by throughput", true},
};

bool is_for(const PresetRow &row, const IntegratorTraits &integrator) {
    for (const std::string &part : split(row.name, ','))
        for (int axis = 0; axis < AXIS_COUNT; axis++)
            if (part.starts_with(axes()[axis].name + "=") && !integrator.reads(axis))
                return false;
    return integrator.has(OPAL_ONE_SAMPLE_MIS) || !row.name.ends_with("mis=one-sample");
}

class CandidateList {
public:
    explicit CandidateList(const SceneDescription &scene) : scene_(scene) {}

    void add(const std::string &name, const std::string &label) {
        Candidate candidate{name, label, scene_};
        candidate.scene.strategy = named_strategy(scene_, name).strategy;
        for (const Candidate &other : all)
            if (is_same(other.scene.strategy, candidate.scene.strategy))
                throw Error(fmt::format("strategy '{}' is the same as '{}' on this scene", name, other.name));
        all.push_back(std::move(candidate));
    }

    void add_preset(bool every) {
        const IntegratorTraits &integrator = integrator_of(scene_.strategy);
        if (!integrator.reads(AXIS_lighting))
            throw Error(fmt::format(
                "the presets course and all compare ways to find light; integrator {} has none: name strategies, "
                "e.g. --strategies hemisphere=uniform hemisphere=cosine, or take --integrator path",
                axes()[AXIS_integrator].choices[size_t(scene_.strategy[AXIS_integrator])].name));
        const bool misses_lights = light_missed_by_bsdfs(scene_) != nullptr;
        for (const PresetRow &row : preset_rows)
            if (is_for(row, integrator) && (every || !row.only_all) &&
                !(misses_lights && row.name.starts_with("lighting=bsdf")) && !(row.only_all && repeats(row)))
                add(row.name, row.label);
    }

    std::vector<Candidate> all;

private:
    const SceneDescription &scene_;

    // Whether the scene has the row's choice already, so that an earlier row is the same.
    bool repeats(const PresetRow &row) const {
        const Strategy strategy = named_strategy(scene_, row.name).strategy;
        return std::ranges::any_of(all, [&](const Candidate &c) { return is_same(c.scene.strategy, strategy); });
    }
};

void check_one_image(const std::vector<Candidate> &all) {
    for (const Candidate &c : all)
        for (const char *what : {"integrator", "max-depth"}) {
            const Strategy &a = all[0].scene.strategy, &b = c.scene.strategy;
            const bool same = what[0] == 'i' ? a[AXIS_integrator] == b[AXIS_integrator] : a.max_depth == b.max_depth;
            if (!same)
                throw Error(fmt::format(
                    "strategies '{}' and '{}' make no sense together: with another {} they estimate different images",
                    all[0].name, c.name, what));
        }
}

} // namespace

std::vector<Candidate> parse_strategies(const SceneDescription &scene, const std::vector<std::string> &words,
                                        const std::vector<std::string> &math) {
    CandidateList list(scene);
    for (const std::string &word : words.empty() ? std::vector<std::string>{"course"} : words)
        for (const std::string &part : split(word, ';'))
            if (part == "course" || part == "all")
                list.add_preset(part == "all");
            else if (part.find('=') == std::string::npos)
                throw Error(fmt::format("--strategies: '{}' is neither a preset (course, all) nor a list "
                                        "axis=value,...; axes: integrator, {}",
                                        part, joined(names_of(strategy_options()))));
            else
                list.add(part, part);
    if (!math.empty()) {
        CandidateList crossed(scene);
        for (const Candidate &c : list.all)
            for (const std::string &mode : math)
                crossed.add(c.name + ",math=" + mode, c.label + "; " + mode + " math");
        list.all = std::move(crossed.all);
    }
    if (list.all.empty())
        throw Error("no strategy is left to compare");
    check_one_image(list.all);
    return std::move(list.all);
}

} // namespace opal
