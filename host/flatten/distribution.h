// Discrete distributions that are drawn from in constant time.
#pragma once

#include "shared/glue.h"

#include <span>
#include <vector>

namespace opal {

// p rounded up to the numbers that a random number of 24 bits may be below: u < p is drawn with this probability
// (cl/core/rng.cl).
double drawn_probability(double p);

// Draw row i = floor(n k1 2^-b) by b random bits k1, keep it if k2 2^-24 < accept[i] by 24 others, else take other[i]:
// index i then comes with probability[i], exactly, for the pairs (k1, k2) that lead to it are counted.
struct AliasTable {
    std::vector<double> probability; // weight / sum of weights, but for the rounding of accept and of floor(n k1 2^-b)
    std::vector<double> accept;      // a multiple of 2^-24, 0 to 1
    std::vector<uint> other;         // an index in [0, n)
};

// The alias method of Vose 1991, "A linear algorithm for generating random numbers with a given distribution".
// Weights are finite, not negative, and one is positive; an index of weight 0 is never drawn, every other is. No
// weights: empty tables. b is 24, or 32 where there are more than OPAL_ALIAS_ROWS weights (cl/emitters/interface.cl
// draws).
AliasTable build_alias_table(std::span<const double> weights);

} // namespace opal
