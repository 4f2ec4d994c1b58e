#include "sweep/strategies.h"

#include "base/error.h"
#include "base/table.h"
#include "scene/load.h"
#include "scene/options.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

struct PresetRow {
    std::string name; // of the strategy
    const char *label;
    bool path, direct, only_all; // for which integrators; `all` has rows that `course` has not
};

const std::vector<PresetRow> preset_rows = {
    {"lighting=bsdf,hemisphere=uniform", "uniform hemisphere", true, true, false},
    {"lighting=bsdf,hemisphere=cosine", "cosine hemisphere", true, true, false},
    {"lighting=emitter", "emitter sampling (NEE)", true, true, false},
    {"lighting=mis,mis=one-sample", "MIS, one sample", false, true, false},
    {"lighting=mis,mis=balance", "MIS, balance heuristic", true, true, false},
    {"lighting=mis,mis=power", "MIS, power heuristic", true, true, false},
    {"lighting=mis,mis=power,emitter-choice=power", "MIS, power; emitters by power", true, true, true},
    {"lighting=mis,mis=power,sampler=stratified", "MIS, power; stratified", true, true, true},
    {"lighting=mis,mis=power,sampler=sobol", "MIS, power; Sobol", true, true, true},
    {"lighting=mis,mis=power,rr=throughput", "MIS, power; roulette by throughput", true, false, true},
};

std::map<std::string, std::string> parse_overrides(const std::string &name) {
    std::map<std::string, std::string> overrides;
    for (size_t begin = 0; begin <= name.size();) {
        const size_t end = std::min(name.find(',', begin), name.size()), equals = name.find('=', begin);
        if (equals >= end)
            throw Error(fmt::format("--strategies: '{}' is neither a preset (course, all) nor a list axis=value,...; axes: integrator, {}",
                                    name, joined(names_of(options()))));
        if (!overrides.emplace(name.substr(begin, equals - begin), name.substr(equals + 1, end - equals - 1)).second)
            throw Error(fmt::format("--strategies: '{}' names {} twice", name, name.substr(begin, equals - begin)));
        begin = end + 1;
    }
    return overrides;
}

bool misses_point_lights(const SceneDescription &scene) {
    return scene.strategy[AXIS_lighting] == CHOICE_lighting_bsdf && !scene.point_lights.empty();
}

class List {
public:
    List(const SceneDescription &scene) : scene_(scene) {}

    void add(const std::string &name, const std::string &label, bool preset) {
        Candidate candidate{name, label, scene_};
        try {
            override_strategy(candidate.scene.strategy, parse_overrides(name));
            if (preset && misses_point_lights(candidate.scene))
                return;
            check_strategy(candidate.scene);
        } catch (const Error &error) {
            throw Error(fmt::format("strategy '{}': {}", name, error.what()));
        }
        const auto same = [&](const Candidate &c) { return c.name == name; };
        if (std::any_of(all.begin(), all.end(), same))
            throw Error(fmt::format("strategy '{}' is named twice", name));
        all.push_back(std::move(candidate));
    }

    void add_preset(bool every) {
        const int integrator = scene_.strategy[AXIS_integrator];
        const bool path = integrator == CHOICE_integrator_path, direct = integrator == CHOICE_integrator_direct_lighting;
        if (!path && !direct)
            throw Error(fmt::format("the presets course and all compare ways to find light; integrator {} has none: name strategies, "
                                    "e.g. --strategies hemisphere=uniform hemisphere=cosine, or take --integrator path",
                                    scene_.integrator_type));
        for (const PresetRow &row : preset_rows)
            if ((path ? row.path : row.direct) && (every || !row.only_all))
                add(row.name, row.label, true);
    }

    std::vector<Candidate> all;

private:
    const SceneDescription &scene_;
};

void check_one_image(const std::vector<Candidate> &all) {
    for (const Candidate &c : all)
        for (const char *what : {"integrator", "max-depth"}) {
            const Strategy &a = all[0].scene.strategy, &b = c.scene.strategy;
            const bool same = what[0] == 'i' ? a[AXIS_integrator] == b[AXIS_integrator] : a.max_depth == b.max_depth;
            if (!same)
                throw Error(fmt::format("strategies '{}' and '{}' make no sense together: with another {} they estimate different images",
                                        all[0].name, c.name, what));
        }
}

} // namespace

std::vector<Candidate> parse_strategies(const SceneDescription &scene, const std::vector<std::string> &words,
                                        const std::vector<std::string> &math) {
    List list(scene);
    for (const std::string &word : words.empty() ? std::vector<std::string>{"course"} : words)
        if (word == "course" || word == "all")
            list.add_preset(word == "all");
        else
            list.add(word, word, false);
    if (!math.empty()) {
        List crossed(scene);
        for (const Candidate &c : list.all)
            for (const std::string &mode : math)
                crossed.add(c.name + ",math=" + mode, c.label + "; " + mode + " math", true);
        list.all = std::move(crossed.all);
    }
    if (list.all.empty())
        throw Error("no strategy is left to compare");
    check_one_image(list.all);
    return std::move(list.all);
}

} // namespace opal
