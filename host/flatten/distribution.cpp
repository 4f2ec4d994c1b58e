#include "flatten/distribution.h"

#include "emitters/list.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace opal {
namespace {

constexpr int random_bits = 24; // of a device's random number

// Weights over the largest one, above 0 where they are: their sum cannot overflow, whatever their scale. Infinite
// weights are alike and leave nothing for others, those that are NaN are 0; if all are 0, all are alike.
std::vector<double> relative_weights(std::span<const double> weights) {
    double largest = 0;
    for (double weight : weights)
        largest = std::max(largest, weight); // never NaN
    std::vector<double> relative;
    for (double weight : weights)
        relative.push_back(!(largest > 0)        ? 1.0
                           : std::isinf(largest) ? double(weight == largest)
                           : weight > 0          ? std::max(weight / largest, std::numeric_limits<double>::denorm_min())
                                                 : 0.0);
    return relative;
}

// Rounds `accept` up to multiples of 2^-24 and sets each probability to the share of pairs (k1, k2) that lead to the
// index.
void set_exact_probabilities(std::span<const double> weights, AliasTable &table) {
    const std::uint64_t count = weights.size(), all = std::uint64_t(1) << random_bits;
    const int row_bits = count > OPAL_ALIAS_ROWS ? 32 : random_bits;
    const auto first_of_row = [&](std::uint64_t row) { return ((row << row_bits) + count - 1) / count; };
    std::vector<std::uint64_t> pairs(count);
    for (std::uint64_t row = 0; row < count; row++) {
        const std::uint64_t numbers = first_of_row(row + 1) - first_of_row(row);
        const double least = weights[row] > 0 ? std::ldexp(1.0, -random_bits) : 0;
        table.accept[row] = std::max(least, drawn_probability(table.accept[row]));
        const auto kept = std::uint64_t(std::ldexp(table.accept[row], random_bits));
        pairs[row] += numbers * kept;
        pairs[table.other[row]] += numbers * (all - kept);
    }
    for (std::uint64_t i = 0; i < count; i++)
        table.probability[i] = std::ldexp(double(pairs[i]), -row_bits - random_bits);
}

} // namespace

double drawn_probability(double p) { return std::ldexp(std::ceil(std::ldexp(p, random_bits)), -random_bits); }

AliasTable build_alias_table(std::span<const double> given) {
    const std::vector<double> weights = relative_weights(given);
    const std::size_t count = weights.size();
    AliasTable table{std::vector<double>(count), std::vector<double>(count, 1.0), std::vector<uint>(count)};
    double sum = 0, lost = 0; // by Kahan's summation: its relative error stays small for weights over many decades
    for (double weight : weights) {
        const double term = weight - lost, next = sum + term;
        lost = (next - sum) - term;
        sum = next;
    }

    // Fills up each row with less than its share from a row with more.
    std::vector<double> share(count); // of a row, 1 on average
    std::vector<uint> small, large;
    for (uint i = 0; i < count; i++) {
        table.probability[i] = weights[i] / sum;
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
    // The rows that remain have a share of 1 up to rounding; their `accept` stays 1.
    set_exact_probabilities(weights, table);
    return table;
}

} // namespace opal
