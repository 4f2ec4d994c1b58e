// Agreement of renders that should have one expectation: every pair is tested, per tile and as a whole.
#pragma once

#include "compare/evidence.h"
#include "strategies/combinations.h"

#include <nlohmann/json_fwd.hpp>

namespace opal {

struct StrategyRender {
    NamedStrategy how;
    Image image;                    // with variance layers
    double samples = 0;             // a pixel
    unsigned long long invalid = 0; // NaN or infinite, left out
    double seconds = 0;             // kernel time
};

struct PairTest {
    size_t a, b; // indices into the renders
    stats::TileTest test;
    double detectable = 0; // relative bias of the image's mean that this pair finds with probability `power`
};

struct Agreement {
    double significance = 0, pair_level = 0; // level of all pairs together, and of each (Sidak)
    double power = 0.9;
    std::vector<PairTest> pairs;    // a < b, in order
    double p_value = 0;             // Sidak over all pairs
    size_t rejected = 0;            // number of rejected pairs
    std::vector<double> detectable; // for each strategy, the least `detectable` of its pairs
    std::string suspect;            // what the disagreeing pairs have in common; empty if all agree
    unsigned long long invalid = 0; // samples of all renders
    bool holds() const { return rejected == 0 && invalid == 0; }
    bool is_rejected(const PairTest &pair) const { return pair.test.rejected(pair_level); }
    const PairTest &worst() const; // the pair with the smallest p
};

// Needs at least two renders of one size, with independent seeds.
Agreement test_agreement(const std::vector<StrategyRender> &renders, double significance);

// The numbered strategies, the matrix of p-values (X: the pair disagrees), and the verdict.
std::string text_of(const Agreement &agreement, const std::vector<StrategyRender> &renders);
nlohmann::json json_of(const Agreement &agreement, const std::vector<StrategyRender> &renders);

} // namespace opal
