#include "sweep/auto.h"

#include "base/json.h"
#include "base/progress.h"
#include "render/kernel_choice.h"
#include "sweep/analysis.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

AutoChoice choose_strategy(const SceneDescription &scene, const Device &device, const Sources &sources, unsigned seed) {
    constexpr double pilot_seconds = 0.25;
    std::vector<Candidate> candidates = parse_strategies(scene, {"course"}, {});
    std::vector<Pilot> pilots;
    RunningProgress progress("pilots");
    for (Candidate &c : candidates) {
        c.scene.strategy.few_paths = suits_general_kernel(device.info, 0);
        CompiledStrategy strategy(device, c, sources, device.info.type == "cpu" ? Clock::cpu : Clock::kernel);
        pilots.push_back(run_pilot(strategy, seed, pilot_seconds));
        progress.update(double(pilots.size()), double(candidates.size()));
    }
    const std::vector<double> costs = pilot_costs(pilots);
    AutoChoice choice;
    choice.chosen = size_t(std::min_element(costs.begin(), costs.end()) - costs.begin());
    choice.strategy = candidates[choice.chosen].scene.strategy;
    const double least = costs[choice.chosen];
    for (size_t i = 0; i < costs.size(); i++)
        choice.candidates.push_back(
            {candidates[i].name, candidates[i].label, least > 0 ? costs[i] / least : 1, pilots[i].spp});
    return choice;
}

std::string AutoChoice::text() const {
    std::string lines;
    for (size_t i = 0; i < candidates.size(); i++) {
        const std::string time = i == chosen ? fmt::format("the fastest to relMSE {}, taken", error_text(ranking_level))
                                             : fmt::format("{:.3g} times longer", candidates[i].relative_time);
        lines += fmt::format("auto    {}: {} (by a pilot of {} samples a pixel)\n", candidates[i].label, time,
                             candidates[i].pilot_spp);
    }
    return lines + "auto    pilots estimate these times; opal sweep measures them";
}

nlohmann::json AutoChoice::json() const {
    nlohmann::json j = object({{"chosen", candidates[chosen].name}, {"candidates", nlohmann::json::array()}});
    for (const Row &row : candidates)
        j["candidates"].push_back(
            object({{"strategy", row.name}, {"relative_time", row.relative_time}, {"pilot_spp", row.pilot_spp}}));
    return j;
}

} // namespace opal
