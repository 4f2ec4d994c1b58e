#include "compare/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal {

namespace {

stats::Estimate estimated(const StrategyRender &r) { return estimate_of(r.image, r.samples, r.samples - 1); }

struct Whole {
    double mean = 0, variance = 0; // of the mean
};

Whole whole_of(const stats::Estimate &e, size_t channel) {
    Whole w;
    const double n = double(e.mean[channel].size());
    for (size_t i = 0; i < e.mean[channel].size(); i++) {
        w.mean += e.mean[channel][i] / n;
        w.variance += e.variance[channel][i] / (n * n);
    }
    return w;
}

// Relative to the mean of both, in the channel where it is least.
double detectable_bias(const stats::Estimate &a, const stats::Estimate &b, double level, double power) {
    double smallest = std::numeric_limits<double>::infinity();
    for (size_t c = 0; c < a.mean.size(); c++) {
        const Whole x = whole_of(a, c), y = whole_of(b, c);
        const double mean = 0.5 * (std::abs(x.mean) + std::abs(y.mean));
        const double error = std::max(std::sqrt(x.variance + y.variance), stats::default_relative_floor * mean);
        if (mean > 0)
            smallest = std::min(smallest, stats::detectable_difference(error, level, power) / mean);
    }
    return smallest;
}

// A group of strategies (one, or all that share a choice), and how well "group against the rest" explains which pairs
// disagree.
struct Suspect {
    std::string name;
    std::vector<bool> members;
    size_t separated = 0, explained = 0; // pairs between the group and the rest; how many of them disagree
    double score = 0;                    // F1 of both; 1 if exactly these pairs disagree
};

std::vector<Suspect> suspects_of(const std::vector<StrategyRender> &renders) {
    std::vector<Suspect> suspects;
    for (size_t i = 0; i < renders.size(); i++) {
        suspects.push_back({renders[i].how.name, std::vector<bool>(renders.size())});
        suspects.back().members[i] = true;
    }
    for (int axis = 0; axis < AXIS_COUNT; axis++)
        for (int choice = 0; choice < int(axes()[axis].choices.size()); choice++) {
            Suspect s{axes()[axis].name + "=" + axes()[axis].choices[choice].name, {}};
            for (const StrategyRender &r : renders)
                s.members.push_back(r.how.strategy[axis] == choice &&
                                    (axis != AXIS_mis || r.how.strategy[AXIS_lighting] == CHOICE_lighting_mis));
            if (std::count(s.members.begin(), s.members.end(), true) > 1)
                suspects.push_back(s);
        }
    return suspects;
}

std::string name_suspect(const Agreement &agreement, const std::vector<StrategyRender> &renders) {
    std::vector<Suspect> suspects = suspects_of(renders);
    for (Suspect &s : suspects) {
        for (const PairTest &pair : agreement.pairs)
            if (s.members[pair.a] != s.members[pair.b]) {
                s.separated++;
                s.explained += agreement.is_rejected(pair);
            }
        s.score = 2.0 * double(s.explained) / double(agreement.rejected + s.separated);
    }
    const auto less = [](const Suspect &a, const Suspect &b) { return a.score < b.score; };
    const Suspect &s = *std::max_element(suspects.begin(), suspects.end(), less);
    const bool alone = s.explained == agreement.rejected && s.explained == s.separated && renders.size() > 2;
    return fmt::format(
        "{} {}: {} of its {} pairs with the others disagree, and {} of the {} pairs among the rest", s.name,
        alone                ? "stands alone"
        : renders.size() > 2 ? "is furthest apart"
                             : "is one of the two",
        s.explained, s.separated, agreement.rejected - s.explained, agreement.pairs.size() - s.separated);
}

} // namespace

const PairTest &Agreement::worst() const {
    return *std::min_element(pairs.begin(), pairs.end(), [](const PairTest &a, const PairTest &b) {
        return a.test.p_value != b.test.p_value ? a.test.p_value < b.test.p_value
                                                : std::abs(a.test.worst_z) > std::abs(b.test.worst_z);
    });
}

Agreement test_agreement(const std::vector<StrategyRender> &renders, double significance) {
    Agreement result;
    result.significance = significance;
    const double pairs = 0.5 * double(renders.size()) * double(renders.size() - 1);
    result.pair_level = stats::sidak_level(significance, pairs);
    result.detectable.assign(renders.size(), std::numeric_limits<double>::infinity());
    for (size_t a = 0; a < renders.size(); a++)
        for (size_t b = a + 1; b < renders.size(); b++) {
            const stats::Estimate x = estimated(renders[a]), y = estimated(renders[b]);
            PairTest pair{a, b, stats::tile_test(x, y)};
            const double level =
                stats::sidak_level(result.pair_level, double(pair.test.p.size() + pair.test.whole.size()));
            pair.detectable = detectable_bias(x, y, level, result.power);
            for (size_t i : {a, b})
                result.detectable[i] = std::min(result.detectable[i], pair.detectable);
            result.rejected += result.is_rejected(pair);
            result.pairs.push_back(std::move(pair));
        }
    for (const StrategyRender &r : renders)
        result.invalid += r.invalid;
    result.p_value = stats::sidak_p(result.worst().test.p_value, pairs);
    if (result.rejected)
        result.suspect = name_suspect(result, renders);
    return result;
}

} // namespace opal
