// The statistics of a sweep: means, ratios and slopes over its replicates, with 95 % confidence intervals.
#pragma once

#include "stats/intervals.h"
#include "sweep/record.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <iterator>

namespace opal {

constexpr double sweep_confidence = 0.95;
constexpr double time_levels[] = {1e-1, 1e-2, 1e-3}; // relMSEs to which times are stated
constexpr double ranking_level = 1e-2;               // the one by which strategies are ranked

// The replicates of one strategy at one number of samples per pixel.
struct PointSummary {
    unsigned spp = 0;
    size_t replicates = 0;
    double seconds = 0; // mean, by the record's clock
    stats::Interval mse, rel_mse;
};

// The time of a strategy to an error, and its ratio to others', have one definition everywhere, seconds_to; so the
// figures of a sweep cannot disagree. Their intervals are by bootstrap over the rounds of replicates, with the same
// draws for all strategies: a disturbance of the machine slows a whole round.
struct StrategySummary {
    const StrategyRecord *record = nullptr;
    std::vector<PointSummary> points; // in the order of spp
    stats::Interval slope;            // of log MSE against log spp, the mean of the replicates' slopes
    std::array<stats::Interval, std::size(time_levels)> times; // seconds to each of these relMSEs
    stats::Interval relative_time;  // seconds to relMSE ranking_level over those of the best strategy
    stats::Interval efficiency;     // seconds of the baseline to its own MSE at the most samples, over this one's
    stats::Interval rel_efficiency; // the same for relMSE
    double bias = 0, bias_p = 1;    // relative bias of the mean luminance, and its p-value (Welch's test)

    stats::Interval ranking_time() const; // seconds to relMSE ranking_level
};

// Seconds of a strategy until an error falls to `level`, by the mean of the replicates with these indices. error:
// Replicate::mse or rel_mse. Independent samples: MSE falls as 1 / spp, so MSE times seconds at the most samples
// decides. Others: along the power law that the points show, from the one of most samples on. NaN if it cannot be told.
double seconds_to(const StrategyRecord &strategy, double Replicate::*error, double level,
                  const std::vector<size_t> &rounds);

struct SweepSummary {
    std::vector<StrategySummary> strategies; // in the record's order; the first is the baseline
    size_t best = 0;                         // index of the strategy with the least time to relMSE ranking_level
};

SweepSummary summarise(const SweepRecord &record);
std::string error_text(double rel_mse);       // "1e-2", "3.4e-3"
std::string csv(const SweepSummary &summary); // one line for each point
// An interval is [estimate, low, high]; infinite and unknown numbers are null.
nlohmann::json json_of(const SweepSummary &summary);

} // namespace opal
