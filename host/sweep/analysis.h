// What the replicates of a sweep say, with intervals of 95 %.
#pragma once

#include "stats/intervals.h"
#include "sweep/record.h"

#include <nlohmann/json_fwd.hpp>

namespace opal {

constexpr double sweep_confidence = 0.95;

struct PointSummary {
    unsigned spp = 0;
    size_t replicates = 0;
    double seconds = 0; // mean
    stats::Interval mse, rel_mse;
};

struct StrategySummary {
    const StrategyRecord *record = nullptr;
    std::vector<PointSummary> points; // by spp
    stats::Interval slope;            // of log MSE against log spp: the mean of the replicates' own slopes
    stats::Interval cost;             // relMSE x seconds at the largest spp: seconds to relMSE 1
    stats::Interval slower;           // cost relative to the best strategy's
    stats::Interval efficiency;       // 1 / (MSE x seconds), relative to the baseline's
    stats::Interval rel_efficiency;   // the same of relMSE
    double bias = 0, bias_p = 1;      // of the mean luminance, relative; Welch's test against the reference
    stats::Interval
    time_to(double rel_mse) const; // seconds; an estimate alone (infinite interval) for dependent samples
};

struct SweepSummary {
    std::vector<StrategySummary> strategies; // in the record's order; the first is the baseline
    size_t best = 0;                         // of the least cost
};

SweepSummary summarise(const SweepRecord &record);
std::string csv(const SweepSummary &summary); // one line a point
nlohmann::json
json_of(const SweepSummary &summary); // an interval is [estimate, low, high], null where infinite or unknown

} // namespace opal
