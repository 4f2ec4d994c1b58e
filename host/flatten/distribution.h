// Discrete distributions that are sampled in constant time, by the alias method.
#pragma once

#include "shared/glue.h"

#include <span>
#include <vector>

namespace opal {

// Rounds p in [0, 1] up to a multiple of 2^-24, the resolution of a device's random number u. The test u < p then
// succeeds with exactly this probability. drawn_probability of rng.cl is the same on the device.
double drawn_probability(double p);

// An alias table of n rows. A draw picks row i = floor(n k1 2^-b) by b random bits k1 and returns i if k2 2^-24 <
// accept[i] by 24 further bits k2, else other[i]. The probability of each index is exact: build_alias_table counts the
// pairs (k1, k2) that lead to it.
struct AliasTable {
    std::vector<double> probability; // of each index: weight / sum of weights, up to the rounding of accept and rows
    std::vector<double> accept;      // a multiple of 2^-24, 0 to 1
    std::vector<uint> other;         // in [0, n)
};

// Builds an alias table (Vose 1991, "A linear algorithm for generating random numbers with a given distribution").
// Weights must not be negative. An index of weight 0 is never drawn, every other one can be. Infinite weights are alike
// and leave nothing for others, NaN counts as 0; if all are 0, all are alike. No weights give an empty table. b is 24,
// or 32 for more than OPAL_ALIAS_ROWS weights (alias_row on the device).
AliasTable build_alias_table(std::span<const double> weights);

} // namespace opal
