#include "flatten/distribution.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace opal {

AliasTable build_alias_table(std::span<const double> weights) {
    const std::size_t count = weights.size();
    AliasTable table{std::vector<double>(count), std::vector<double>(count, 1.0), std::vector<uint>(count)};
    // Weights over many decades: divided by the largest they cannot overflow, and the sum's error stays relative.
    double largest = 0, sum = 0, lost = 0;
    for (double weight : weights)
        largest = std::max(largest, weight);
    for (double weight : weights) { // Kahan
        const double term = weight / largest - lost, next = sum + term;
        lost = (next - sum) - term;
        sum = next;
    }
    assert(count == 0 || (largest > 0 && std::isfinite(sum)));

    // Fill each row that holds less than its share from one that holds more.
    std::vector<double> share(count); // of a row, 1 on average
    std::vector<uint> small, large;
    for (uint i = 0; i < count; i++) {
        table.probability[i] = weights[i] / largest / sum;
        share[i] = table.probability[i] * double(count);
        table.other[i] = i;
        (share[i] < 1 ? small : large).push_back(i);
    }
    while (!small.empty() && !large.empty()) {
        const uint poor = small.back(), rich = large.back();
        small.pop_back();
        table.accept[poor] = share[poor];
        table.other[poor] = rich;
        share[rich] = (share[rich] + share[poor]) - 1;
        if (share[rich] < 1) {
            large.pop_back();
            small.push_back(rich);
        }
    }
    // What is left is 1 but for rounding, and keeps itself.
    return table;
}

} // namespace opal
