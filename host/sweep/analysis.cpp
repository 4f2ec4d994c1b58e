#include "sweep/analysis.h"

#include "base/json.h"
#include "stats/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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

double mse_seconds(const Replicate &r) { return r.mse * r.seconds; }
double rel_mse_seconds(const Replicate &r) { return r.rel_mse * r.seconds; }

// The ratio of two points' means. Replicates are paired by rounds, because a disturbance of the machine slows a whole
// round.
template <class Value> stats::Interval ratio_of(const SweepPoint &a, const SweepPoint &b, Value value) {
    std::vector<double> x = values_of(a, value), y = values_of(b, value);
    const size_t rounds = std::min(x.size(), y.size());
    x.resize(rounds), y.resize(rounds);
    return stats::paired_ratio_interval(x, y, sweep_confidence);
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

stats::Interval StrategySummary::time_to(double rel_mse) const {
    if (record->independent)
        return {cost.estimate / rel_mse, cost.low / rel_mse, cost.high / rel_mse};
    const PointSummary &last = points.back();
    return {last.seconds * std::pow(last.rel_mse.estimate / rel_mse, -1 / slope.estimate)};
}

SweepSummary summarise(const SweepRecord &record) {
    SweepSummary summary;
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
        s.cost = stats::positive_mean_interval(sample_of(r.points.back(), rel_mse_seconds), sweep_confidence);
        test_bias(s, r.points.back(), record.reference);
        summary.strategies.push_back(std::move(s));
    }
    std::vector<StrategySummary> &all = summary.strategies;
    const auto cheaper = [](const StrategySummary &a, const StrategySummary &b) {
        return a.cost.estimate < b.cost.estimate;
    };
    summary.best = size_t(std::min_element(all.begin(), all.end(), cheaper) - all.begin());
    for (StrategySummary &s : all) {
        const SweepPoint &own = s.record->points.back(), &first = all[0].record->points.back(),
                         &best = all[summary.best].record->points.back();
        s.relative_time = ratio_of(own, best, rel_mse_seconds);
        s.efficiency = ratio_of(first, own, mse_seconds);
        s.rel_efficiency = ratio_of(first, own, rel_mse_seconds);
        if (&s == &all[summary.best])
            s.relative_time = {1, 1, 1};
        if (&s == &all[0])
            s.efficiency = s.rel_efficiency = {1, 1, 1};
    }
    return summary;
}

nlohmann::json json_of(const SweepSummary &summary) {
    const auto interval = [](const stats::Interval &i) { return nlohmann::json{i.estimate, i.low, i.high}; };
    nlohmann::json list = nlohmann::json::array();
    for (const StrategySummary &s : summary.strategies) {
        nlohmann::json j = object({{"name", s.record->name},
                                   {"slope", interval(s.slope)},
                                   {"seconds_to_rel_mse_1_percent", interval(s.time_to(0.01))},
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
