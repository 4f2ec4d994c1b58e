// Do renders that mean the same agree? Every pair is tested per tile and as a whole.
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
    double seconds = 0;             // of kernel time
};

struct PairTest {
    size_t a, b; // indices into the renders
    stats::TileTest test;
    double detectable =
        0; // bias of the image's mean that this pair finds with probability `power`, relative to the mean
};

struct Agreement {
    double significance = 0, pair_level = 0; // of all together, and of each pair (Sidak)
    double power = 0.9;
    std::vector<PairTest> pairs;    // a < b, in order
    double p_value = 0;             // Sidak over all pairs
    size_t rejected = 0;            // pairs
    std::vector<double> detectable; // of each strategy: by the other that sees it best
    std::string suspect;            // what the disagreeing pairs have in common; empty where all agree
    unsigned long long invalid = 0; // samples of all renders
    bool holds() const { return rejected == 0 && invalid == 0; }
    bool is_rejected(const PairTest &pair) const { return pair.test.rejected(pair_level); }
    const PairTest &worst() const; // of the smallest p
};

// At least two renders of one size, of independent seeds.
Agreement test_agreement(const std::vector<StrategyRender> &renders, double significance);

// The strategies, numbered; the matrix of p-values, X where a pair disagrees; the verdict.
std::string text_of(const Agreement &agreement, const std::vector<StrategyRender> &renders);
nlohmann::json json_of(const Agreement &agreement, const std::vector<StrategyRender> &renders);

} // namespace opal
