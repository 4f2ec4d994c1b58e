#include "strategies/combinations.h"

#include "base/error.h"
#include "scene/options.h"
#include "strategies/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

namespace opal {

std::vector<std::string> split(const std::string &text, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(text);
    for (std::string part; std::getline(stream, part, separator);) {
        const size_t first = part.find_first_not_of(" \n"), last = part.find_last_not_of(" \n");
        if (first != std::string::npos)
            parts.push_back(part.substr(first, last - first + 1));
    }
    return parts;
}

namespace {

using Choices = std::array<int, AXIS_COUNT>;

std::map<std::string, std::string> overrides_of(const std::string &text) {
    std::map<std::string, std::string> overrides;
    for (const std::string &part : split(text, ',')) {
        const size_t equals = part.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == part.size())
            throw Error(fmt::format("'{}' is not AXIS=CHOICE, as in lighting=mis,mis=power;lighting=emitter", part));
        if (!overrides.emplace(part.substr(0, equals), part.substr(equals + 1)).second)
            throw Error(fmt::format("'{}' is given twice", part.substr(0, equals)));
    }
    return overrides;
}

// What a scene has of the things that make an axis matter.
class AxisNeeds {
public:
    explicit AxisNeeds(const SceneDescription &scene) {
        size_t emitters = scene.lights.size();
        for (const Mesh &mesh : scene.meshes) {
            const auto *triangles = std::get_if<TriangleMesh>(&mesh.shape);
            emitters += mesh.radiance.has_value();
            light_triangles_ = light_triangles_ || (mesh.radiance && triangles && triangles->triangles.size() > 1);
            diffuse_ = diffuse_ || mesh.bsdf.leads_to(BSDF_diffuse);
            refracts_ = refracts_ || (mesh.bsdf.traits() & OPAL_TRANSMITS);
        }
        many_emitters_ = emitters > 1;
    }

    bool refracts() const { return refracts_; }
    bool matters(int axis, const Strategy &strategy) const {
        return integrator_of(strategy).reads(axis) && (axes()[axis].needs & ~met(strategy)) == 0;
    }

private:
    bool many_emitters_ = false, light_triangles_ = false, diffuse_ = false, refracts_ = false;

    // What the scene and the strategy have: OPAL_NEEDS_*.
    unsigned met(const Strategy &strategy) const {
        const IntegratorTraits &integrator = integrator_of(strategy);
        const bool diffuse_samples =
            !integrator.has(OPAL_ASKS_BSDFS) ||
            (diffuse_ && (integrator.has(OPAL_FOLLOWS_PATHS) || strategy[AXIS_lighting] != CHOICE_lighting_emitter));
        const std::pair<unsigned, bool> needs[] = {
            {OPAL_NEEDS_MIS, strategy[AXIS_lighting] == CHOICE_lighting_mis},
            {OPAL_NEEDS_EMITTER_SAMPLES, samples_emitters(strategy)},
            {OPAL_NEEDS_MANY_EMITTERS, many_emitters_},
            {OPAL_NEEDS_MESH_LIGHTS, light_triangles_},
            {OPAL_NEEDS_DIFFUSE_SAMPLES, diffuse_samples},
            {OPAL_NEEDS_ROULETTE, strategy.max_depth > strategy.rr_depth},
        };
        unsigned all = 0;
        for (const auto &[need, is_met] : needs)
            all |= is_met ? need : 0;
        return all;
    }
};

// Finds all combinations. Copies the scene without its shapes, so that copies are cheap.
class Combinations {
public:
    explicit Combinations(const SceneDescription &scene) : scene_(scene), needs_(scene) {
        for (Mesh &mesh : scene_.meshes)
            mesh.shape = Parallelogram{};
    }

    std::vector<Choices> all() {
        extend(AXIS_integrator + 1, scene_.strategy.choices);
        return found_;
    }

private:
    SceneDescription scene_;
    AxisNeeds needs_;
    std::vector<Choices> found_;

    // Axes are decided in order. Whether an axis matters depends on the choices of the axes before it.
    bool matters(int axis, const Choices &chosen) const {
        Strategy strategy = scene_.strategy;
        strategy.choices = chosen;
        return needs_.matters(axis, strategy);
    }

    bool is_unbiased_and_ends(int axis, int choice) const {
        if (axis == AXIS_lighting && choice == CHOICE_lighting_bsdf)
            return !light_missed_by_bsdfs(scene_);
        if (axis == AXIS_rr && choice == CHOICE_rr_off)
            return scene_.strategy.max_depth != no_limit;
        return true;
    }

    bool repeats_another(int axis, int choice) const {
        return axis == AXIS_rr && choice == CHOICE_rr_throughput_eta && !needs_.refracts();
    }

    void extend(int axis, Choices chosen) {
        if (axis == AXIS_COUNT)
            return add(chosen);
        if (!matters(axis, chosen)) {
            if (axis == AXIS_mis) // one_sample has no meaning without MIS
                chosen[axis] = CHOICE_mis_balance;
            return extend(axis + 1, chosen);
        }
        for (int choice = 0; choice < int(axes()[axis].choices.size()); choice++) {
            if (!is_unbiased_and_ends(axis, choice) || repeats_another(axis, choice))
                continue;
            chosen[axis] = choice;
            extend(axis + 1, chosen);
        }
    }

    void add(const Choices &chosen) {
        scene_.strategy.choices = chosen;
        try {
            check_strategy(scene_);
        } catch (const Error &) {
            return;
        }
        found_.push_back(chosen);
    }
};

using Pair = std::array<int, 4>; // axis, choice, axis, choice

std::vector<Pair> pairs_of(const Choices &c) {
    std::vector<Pair> pairs;
    for (int a = 0; a < AXIS_COUNT; a++)
        for (int b = a + 1; b < AXIS_COUNT; b++)
            pairs.push_back({a, c[a], b, c[b]});
    return pairs;
}

std::vector<Choices> covering_set(const std::vector<Choices> &all) {
    std::set<Pair> open;
    for (const Choices &c : all)
        for (const Pair &pair : pairs_of(c))
            open.insert(pair);
    const auto gain = [&](const Choices &c) {
        const auto pairs = pairs_of(c);
        return std::count_if(pairs.begin(), pairs.end(), [&](const Pair &pair) { return open.contains(pair); });
    };
    std::vector<Choices> chosen;
    while (!open.empty()) {
        const Choices *best = &all.front();
        if (!chosen.empty())
            best = &*std::max_element(all.begin(), all.end(),
                                      [&](const Choices &a, const Choices &b) { return gain(a) < gain(b); });
        chosen.push_back(*best);
        for (const Pair &pair : pairs_of(*best))
            open.erase(pair);
    }
    return chosen;
}

std::string name_of(const Choices &c, const std::vector<Choices> &set) {
    std::string name;
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        const bool differs =
            std::any_of(set.begin(), set.end(), [&](const Choices &other) { return other[axis] != c[axis]; });
        const bool says_nothing = axis == AXIS_mis && c[AXIS_lighting] != CHOICE_lighting_mis;
        if (differs && !says_nothing)
            name +=
                fmt::format("{}{}={}", name.empty() ? "" : ",", axes()[axis].name, axes()[axis].choices[c[axis]].name);
    }
    return name.empty() ? "the scene's" : name;
}

} // namespace

bool is_same(const Strategy &a, const Strategy &b) {
    return a.choices == b.choices &&
           std::all_of(strategy_options().begin(), strategy_options().end(),
                       [&](const StrategyOption &option) { return option.text(a) == option.text(b); });
}

NamedStrategy named_strategy(const SceneDescription &scene, const std::string &text) {
    SceneDescription trial = scene;
    try {
        override_strategy(trial.strategy, overrides_of(text));
        check_strategy(trial);
    } catch (const Error &error) {
        throw Error(fmt::format("strategy '{}': {}", text, error.what()));
    }
    return {text, trial.strategy};
}

std::vector<NamedStrategy> named_strategies(const SceneDescription &scene, const std::string &text) {
    std::vector<NamedStrategy> strategies;
    for (const std::string &part : split(text, ';')) {
        const NamedStrategy named = named_strategy(scene, part);
        for (const NamedStrategy &other : strategies)
            if (is_same(other.strategy, named.strategy))
                throw Error(fmt::format("strategy '{}' is the same as '{}' on this scene", part, other.name));
        strategies.push_back(named);
    }
    return strategies;
}

std::vector<int> acting_axes(const SceneDescription &scene) {
    const AxisNeeds needs(scene);
    std::vector<int> acting;
    for (int axis = 0; axis < AXIS_COUNT; axis++)
        if (axis == AXIS_integrator || needs.matters(axis, scene.strategy))
            acting.push_back(axis);
    return acting;
}

std::vector<NamedStrategy> sensible_strategies(const SceneDescription &scene, size_t most) {
    std::vector<Choices> all = Combinations(scene).all();
    if (const auto own = std::find(all.begin(), all.end(), scene.strategy.choices); own != all.end())
        std::rotate(all.begin(), own, own + 1);
    if (all.size() > most)
        all = covering_set(all);
    std::vector<NamedStrategy> strategies;
    for (const Choices &c : all) {
        strategies.push_back({name_of(c, all), scene.strategy});
        strategies.back().strategy.choices = c;
    }
    return strategies;
}

} // namespace opal
