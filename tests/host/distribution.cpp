#include "flatten/distribution.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace opal;

namespace {

// What a draw from the table really gives each index.
std::vector<double> drawn(const AliasTable &table) {
    const double count = double(table.accept.size());
    std::vector<double> probability(table.accept.size());
    for (std::size_t i = 0; i < table.accept.size(); i++) {
        probability[i] += table.accept[i] / count;
        probability[table.other[i]] += (1 - table.accept[i]) / count;
    }
    return probability;
}

// The largest difference between what is drawn and what the weights ask for, over the probability of one row.
double error_of(const AliasTable &table, const std::vector<double> &weights) {
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const std::vector<double> got = drawn(table);
    double error = 0;
    for (std::size_t i = 0; i < weights.size(); i++)
        error = std::max(error, std::abs(got[i] - weights[i] / sum) * double(weights.size()));
    return error;
}

} // namespace

TEST_CASE("an alias table draws what the weights say", "[distribution]") {
    const std::vector<double> weights =
        GENERATE(std::vector<double>{3}, std::vector<double>{1, 1, 1, 1}, std::vector<double>{0, 2, 0, 1},
                 std::vector<double>{1e-300, 3e-300}, std::vector<double>{1e308, 1e308, 1e307});
    const AliasTable table = build_alias_table(weights);
    std::vector<double> scaled = weights; // whose sum is finite
    for (double &weight : scaled)
        weight /= *std::max_element(weights.begin(), weights.end());
    CHECK(error_of(table, scaled) < 1e-15);
    for (std::size_t i = 0; i < weights.size(); i++) {
        CHECK((table.accept[i] >= 0 && table.accept[i] <= 1));
        CHECK(table.other[i] < weights.size());
        if (weights[i] == 0)
            CHECK(drawn(table)[i] == 0);
    }
}

TEST_CASE("an alias table of 100 000 weights over 12 decades", "[distribution]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> decade(-12, 0);
    std::vector<double> weights(100000);
    for (double &weight : weights)
        weight = std::pow(10.0, decade(random));
    const AliasTable table = build_alias_table(weights);

    CHECK(std::abs(std::accumulate(table.probability.begin(), table.probability.end(), 0.0) - 1) < 1e-11);
    CHECK(error_of(table, weights) < 1e-9); // of a row; rounding of at most 1e5 steps of 1e-16
    // A small weight is right relative to itself, not to the sum.
    const std::vector<double> got = drawn(table);
    for (std::size_t i = 0; i < weights.size(); i++)
        if (std::abs(got[i] / table.probability[i] - 1) > 1e-9)
            FAIL("index " << i << ": " << got[i] << ", not " << table.probability[i]);
}

TEST_CASE("the error of a wrong alias table is seen", "[distribution]") {
    const std::vector<double> weights{1, 2, 3, 4};
    AliasTable table = build_alias_table(weights);
    table.accept[0] *= 0.99;
    CHECK(error_of(table, weights) > 1e-3);
}

TEST_CASE("no weights, no rows", "[distribution]") { CHECK(build_alias_table({}).accept.empty()); }
