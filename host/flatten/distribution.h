// Discrete distributions that are drawn from in constant time.
#pragma once

#include "shared/glue.h"

#include <span>
#include <vector>

namespace opal {

// Draw row i = floor(n u1), keep it if u2 < accept[i], else take other[i]: index i then comes with probability[i].
struct AliasTable {
    std::vector<double> probability; // weight / sum of weights
    std::vector<double> accept;      // 0 to 1
    std::vector<uint> other;         // an index in [0, n)
};

// The alias method of Vose 1991, "A linear algorithm for generating random numbers with a given distribution".
// Weights are finite, not negative, and one is positive; an index of weight 0 is never drawn. No weights: empty tables.
AliasTable build_alias_table(std::span<const double> weights);

} // namespace opal
