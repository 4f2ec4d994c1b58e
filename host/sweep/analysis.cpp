#include "sweep/analysis.h"

#include "base/json.h"
#include "stats/bootstrap.h"
#include "stats/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace opal {

namespace {

using stats::Moments;
using stats::Sample;

template <class Value> std::vector<double> values_of(const SweepPoint &point, Value value) {
    std::vector<double> values;
    for (const Replicate &r : point.replicates)
        values.push_back(value(r));
    return values;
}

template <class Value> Sample sample_of(const SweepPoint &point, Value value) {
    Moments moments;
    for (double v : values_of(point, value))
        moments.add(v);
    return moments.sample();
}

constexpr size_t bootstrap_count = 1000;
constexpr unsigned bootstrap_seed = 1;

// Rounds of which every point of every strategy has a replicate.
size_t whole_rounds(const SweepRecord &record) {
    size_t rounds = SIZE_MAX;
    for (const StrategyRecord &s : record.strategies)
        for (const SweepPoint &p : s.points)
            rounds = std::min(rounds, p.replicates.size());
    return rounds == SIZE_MAX ? 0 : rounds;
}

template <class Value> double mean_of(const SweepPoint &point, const std::vector<size_t> &rounds, Value value) {
    double sum = 0;
    for (size_t round : rounds)
        sum += value(point.replicates[round]);
    return sum / double(rounds.size());
}

// The mean slope of log MSE against log spp. Each replicate gives one slope: replicates are independent of each other,
// the points of one replicate share samples and are not.
stats::Interval slope_of(const StrategyRecord &s) {
    Moments slopes;
    for (size_t r = 0; r < s.points.back().replicates.size(); r++) {
        std::vector<double> spp, mse;
        for (const SweepPoint &p : s.points)
            if (r < p.replicates.size() && p.replicates[r].mse > 0) {
                spp.push_back(p.spp);
                mse.push_back(p.replicates[r].mse);
            }
        if (const double slope = stats::fit_log_log(spp, mse, {}, sweep_confidence).slope.estimate;
            std::isfinite(slope))
            slopes.add(slope);
    }
    return stats::mean_interval(slopes.sample(), sweep_confidence);
}

// Welch's test of the mean luminance against the reference's.
void test_bias(StrategySummary &s, const SweepPoint &largest, const ReferenceRecord &reference) {
    const Sample means = sample_of(largest, [](const Replicate &r) { return r.mean_luminance; });
    if (means.n < 2 || !(reference.mean_luminance > 0))
        return;
    const double own = means.variance / means.n, other = reference.stderr_luminance * reference.stderr_luminance;
    const double difference = means.mean - reference.mean_luminance;
    s.bias = difference / reference.mean_luminance;
    s.bias_p = stats::difference_test(difference, std::sqrt(own + other),
                                      stats::welch_dof(own, means.n - 1, other, INFINITY), reference.mean_luminance)
                   .p_value;
}

} // namespace

double seconds_to(const StrategyRecord &strategy, double Replicate::*error, double level,
                  const std::vector<size_t> &rounds) {
    const SweepPoint &last = strategy.points.back();
    if (strategy.independent)
        return mean_of(last, rounds, [&](const Replicate &r) { return r.*error * r.seconds; }) / level;
    std::vector<double> seconds, errors;
    for (const SweepPoint &p : strategy.points) {
        seconds.push_back(mean_of(p, rounds, [](const Replicate &r) { return r.seconds; }));
        errors.push_back(mean_of(p, rounds, [&](const Replicate &r) { return r.*error; }));
    }
    const double slope = stats::fit_log_log(seconds, errors, {}, sweep_confidence).slope.estimate;
    return slope < 0 ? seconds.back() * std::pow(errors.back() / level, -1 / slope) : NAN;
}

stats::Interval StrategySummary::ranking_time() const {
    return times[size_t(std::find(std::begin(time_levels), std::end(time_levels), ranking_level) - time_levels)];
}

SweepSummary summarise(const SweepRecord &record) {
    SweepSummary summary;
    const auto draws = stats::bootstrap_draws(whole_rounds(record), bootstrap_count, bootstrap_seed);
    const auto interval_of = [&](const auto &statistic) {
        return stats::bootstrap_interval(draws, sweep_confidence, statistic);
    };
    for (const StrategyRecord &r : record.strategies) {
        if (r.points.empty())
            continue;
        StrategySummary s;
        s.record = &r;
        for (const SweepPoint &p : r.points) {
            const auto mean = [&](double Replicate::*f) {
                return sample_of(p, [f](const Replicate &x) { return x.*f; });
            };
            s.points.push_back({p.spp, p.replicates.size(), mean(&Replicate::seconds).mean,
                                stats::positive_mean_interval(mean(&Replicate::mse), sweep_confidence),
                                stats::positive_mean_interval(mean(&Replicate::rel_mse), sweep_confidence)});
        }
        s.slope = slope_of(r);
        for (size_t level = 0; level < std::size(time_levels); level++)
            s.times[level] = interval_of(
                [&](const auto &rounds) { return seconds_to(r, &Replicate::rel_mse, time_levels[level], rounds); });
        test_bias(s, r.points.back(), record.reference);
        summary.strategies.push_back(std::move(s));
    }
    std::vector<StrategySummary> &all = summary.strategies;
    if (all.empty())
        return summary;
    const auto faster = [](const StrategySummary &a, const StrategySummary &b) {
        const double x = a.ranking_time().estimate, y = b.ranking_time().estimate;
        return x < y || (std::isfinite(x) && !std::isfinite(y));
    };
    summary.best = size_t(std::min_element(all.begin(), all.end(), faster) - all.begin());
    const StrategyRecord &best = *all[summary.best].record, &first = *all[0].record;
    // The ratio of the seconds of a to those of b, to the same error.
    const auto ratio = [&](const StrategyRecord &a, const StrategyRecord &b, double Replicate::*error, double level) {
        if (&a == &b)
            return stats::Interval{1, 1, 1};
        return interval_of([&](const auto &rounds) {
            return seconds_to(a, error, level, rounds) / seconds_to(b, error, level, rounds);
        });
    };
    std::vector<size_t> all_rounds(first.points.back().replicates.size());
    std::iota(all_rounds.begin(), all_rounds.end(), size_t(0));
    const auto reached = [&](double Replicate::*error) {
        return mean_of(first.points.back(), all_rounds, [&](const Replicate &r) { return r.*error; });
    };
    for (StrategySummary &s : all) {
        s.relative_time = ratio(*s.record, best, &Replicate::rel_mse, ranking_level);
        s.efficiency = ratio(first, *s.record, &Replicate::mse, reached(&Replicate::mse));
        s.rel_efficiency = ratio(first, *s.record, &Replicate::rel_mse, reached(&Replicate::rel_mse));
    }
    return summary;
}

nlohmann::json json_of(const SweepSummary &summary) {
    const auto interval = [](const stats::Interval &i) { return nlohmann::json{i.estimate, i.low, i.high}; };
    nlohmann::json list = nlohmann::json::array();
    for (const StrategySummary &s : summary.strategies) {
        nlohmann::json j = object({{"name", s.record->name},
                                   {"slope", interval(s.slope)},
                                   {"seconds_to_rel_mse_1_percent", interval(s.ranking_time())},
                                   {"time_relative_to_best", interval(s.relative_time)},
                                   {"efficiency_relative_to_first", interval(s.efficiency)},
                                   {"rel_mse_efficiency_relative_to_first", interval(s.rel_efficiency)},
                                   {"bias", s.bias},
                                   {"bias_p", s.bias_p}});
        for (const PointSummary &p : s.points)
            j["points"].push_back(object({{"spp", p.spp},
                                          {"replicates", p.replicates},
                                          {"seconds", p.seconds},
                                          {"mse", interval(p.mse)},
                                          {"rel_mse", interval(p.rel_mse)}}));
        list.push_back(j);
    }
    return list;
}

std::string error_text(double x) {
    if (!(x > 0))
        return fmt::format("{:g}", x);
    const int exponent = int(std::floor(std::log10(x) + 1e-9));
    return fmt::format("{:.2g}e{}", x / std::pow(10, exponent), exponent);
}

std::string csv(const SweepSummary &summary) {
    std::string text = "strategy,spp,replicates,seconds,mse,mse_low,mse_high,rel_mse,rel_mse_low,rel_mse_high\n";
    for (const StrategySummary &s : summary.strategies)
        for (const PointSummary &p : s.points)
            text += fmt::format("\"{}\",{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", s.record->name,
                                p.spp, p.replicates, p.seconds, p.mse.estimate, p.mse.low, p.mse.high,
                                p.rel_mse.estimate, p.rel_mse.low, p.rel_mse.high);
    return text;
}

} // namespace opal
