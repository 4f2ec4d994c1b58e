// The statistics of a sweep: means, ratios and slopes over its replicates, with 95 % confidence intervals.
#pragma once

#include "stats/intervals.h"
#include "sweep/record.h"

#include <nlohmann/json_fwd.hpp>

namespace opal {

constexpr double sweep_confidence = 0.95;

// The replicates of one strategy at one number of samples per pixel.
struct PointSummary {
    unsigned spp = 0;
    size_t replicates = 0;
    double seconds = 0; // mean, by the record's clock
    stats::Interval mse, rel_mse;
};

struct StrategySummary {
    const StrategyRecord *record = nullptr;
    std::vector<PointSummary> points; // in the order of spp
    stats::Interval slope;            // of log MSE against log spp, the mean of the replicates' slopes
    stats::Interval cost;             // relMSE x seconds at the largest spp: the seconds to relMSE 1
    stats::Interval relative_time;    // cost over that of the best strategy
    stats::Interval efficiency;       // 1 / (MSE x seconds) over that of the baseline
    stats::Interval rel_efficiency;   // the same for relMSE
    double bias = 0, bias_p = 1;      // relative bias of the mean luminance, and its p-value (Welch's test)

    // The seconds to this relMSE. For dependent samples the estimate comes without an interval (it is infinite).
    stats::Interval time_to(double rel_mse) const;
};

struct SweepSummary {
    std::vector<StrategySummary> strategies; // in the record's order; the first is the baseline
    size_t best = 0;                         // index of the strategy with the least cost
};

SweepSummary summarise(const SweepRecord &record);
std::string csv(const SweepSummary &summary); // one line for each point
// An interval is [estimate, low, high]; infinite and unknown numbers are null.
nlohmann::json json_of(const SweepSummary &summary);

} // namespace opal
