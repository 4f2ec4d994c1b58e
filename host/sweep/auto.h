// --strategy auto: the fastest way to sample light on this scene and device, found by short pilots. Their figures are
// estimates of what a sweep measures (sweep/analysis.h: seconds_to).
#pragma once

#include "sweep/measure.h"

#include <nlohmann/json_fwd.hpp>

namespace opal {

struct AutoChoice {
    struct Row {
        std::string name, label; // as in Candidate
        double relative_time;    // seconds to relMSE ranking_level over those of the best one, as a sweep has it
        unsigned pilot_spp;
    };
    std::vector<Row> candidates;
    size_t chosen = 0; // place among them
    Strategy strategy; // of the chosen one

    std::string text() const; // a line each
    nlohmann::json json() const;
};

// Pilots of the sweep's preset `course`. Their samples have indices of their own and are in no image.
AutoChoice choose_strategy(const SceneDescription &scene, const Device &device, const Sources &sources, unsigned seed);

} // namespace opal
