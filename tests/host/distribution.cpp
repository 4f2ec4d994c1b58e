#include "flatten/distribution.h"

#include "emitters/list.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>

using namespace opal;

namespace {

// The upper word of the product, by which the device chooses a row.
unsigned row_of(std::uint64_t number, int bits, std::uint64_t rows) {
    return unsigned((number << (32 - bits)) * rows >> 32);
}

// How many of the 2^bits numbers lead to each row, by bisection.
std::vector<double> numbers_of_rows(std::uint64_t rows) {
    const int bits = rows > OPAL_ALIAS_ROWS ? 32 : 24;
    std::vector<double> firsts(rows + 1, std::ldexp(1.0, bits));
    for (unsigned row = 0; row < rows; row++) {
        std::uint64_t low = 0, high = std::uint64_t(1) << bits; // the first number that leads to `row` or beyond
        while (low < high) {
            const std::uint64_t middle = (low + high) / 2;
            if (row_of(middle, bits, rows) < row)
                low = middle + 1;
            else
                high = middle;
        }
        firsts[row] = double(low);
    }
    std::vector<double> numbers(rows);
    for (unsigned row = 0; row < rows; row++)
        numbers[row] = std::ldexp(firsts[row + 1] - firsts[row], -bits);
    return numbers;
}

// The probability that a draw from the table gives each index: a sum of multiples of 2^-48 or 2^-56.
std::vector<double> drawn(const AliasTable &table) {
    const std::vector<double> row = numbers_of_rows(table.accept.size());
    std::vector<double> probability(table.accept.size());
    for (std::size_t i = 0; i < table.accept.size(); i++) {
        probability[i] += row[i] * table.accept[i];
        probability[table.other[i]] += row[i] * (1 - table.accept[i]);
    }
    return probability;
}

// Whether each index is drawn by its weight, but for roundings: a row has a whole number of numbers, and its accept is
// rounded up by less than 2^-24, at the cost of the index that gets the rest.
bool near(const AliasTable &table, const std::vector<double> &weights) {
    const double count = double(weights.size()), sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> roundings(weights.size(), 1);
    for (uint other : table.other)
        roundings[other]++;
    const std::vector<double> got = drawn(table);
    for (std::size_t i = 0; i < weights.size(); i++) {
        const double wished = weights[i] / sum;
        const double limit = wished * (count * std::ldexp(1.0, count > OPAL_ALIAS_ROWS ? -32 : -24) + 1e-9) +
                             roundings[i] * 0x1p-24 / count;
        if (!(std::abs(got[i] - wished) <= limit))
            return false;
    }
    return true;
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
    CHECK(near(table, scaled));
    CHECK(drawn(table) == table.probability);
    for (std::size_t i = 0; i < weights.size(); i++) {
        CHECK((table.accept[i] >= 0 && table.accept[i] <= 1));
        CHECK(table.other[i] < weights.size());
        if (weights[i] == 0)
            CHECK(drawn(table)[i] == 0);
    }
}

TEST_CASE("an alias table states what is drawn, number by number", "[distribution]") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> decade(-12, 0);
    for (std::size_t count : {1u, 2u, 3u, 5u, 100u, 1000u, 65537u, 1u << 20, (1u << 20) + 1, 3000000u}) {
        std::vector<double> weights(count);
        for (double &weight : weights)
            weight = std::pow(10.0, decade(random));
        const AliasTable table = build_alias_table(weights);
        INFO(count << " weights");
        CHECK(drawn(table) == table.probability);
        CHECK(std::abs(std::accumulate(table.probability.begin(), table.probability.end(), 0.0) - 1) < 1e-11);
        CHECK(*std::min_element(table.probability.begin(), table.probability.end()) > 0);
        CHECK(std::all_of(table.accept.begin(), table.accept.end(),
                          [](double a) { return std::ldexp(a, 24) == std::floor(std::ldexp(a, 24)); }));
        CHECK(near(table, weights));
    }
}

TEST_CASE("the error of a wrong alias table is seen", "[distribution]") {
    const std::vector<double> weights{1, 2, 3, 4};
    AliasTable table = build_alias_table(weights);
    table.accept[0] *= 0.99;
    CHECK(!near(table, weights));
    CHECK(drawn(table) != table.probability);
}

TEST_CASE("no weights, no rows", "[distribution]") { CHECK(build_alias_table({}).accept.empty()); }

TEST_CASE("Weights of any scale give a table: tiny, huge, infinite, NaN and all zero", "[distribution]") {
    const double inf = INFINITY, nan = NAN, tiny = 5e-324;
    const std::vector<std::pair<std::vector<double>, std::vector<double>>> cases = {
        {{1e300, 3e300}, {1, 3}},      {{1.7e308, 1.7e308, 1.7e308}, {1, 1, 1}},
        {{tiny, 3 * tiny}, {1, 3}},    {{1e-320, 0, 1e-320}, {1, 0, 1}},
        {{0, 0, 0}, {1, 1, 1}},        {{inf, 1, inf}, {1, 0, 1}},
        {{nan, 2, 6}, {0, 1, 3}},      {{nan, nan}, {1, 1}},
        {{nan, inf, 1e300}, {0, 1, 0}}};
    for (const auto &[weights, meant] : cases) {
        const AliasTable table = build_alias_table(weights);
        CHECK(near(table, meant));
        const std::vector<double> probabilities = drawn(table);
        for (std::size_t i = 0; i < weights.size(); i++) {
            CHECK(table.probability[i] == probabilities[i]);
            CHECK((probabilities[i] > 0) == (meant[i] > 0));
            CHECK(table.other[i] < weights.size());
        }
    }
    const AliasTable far = build_alias_table(std::vector<double>{1e-300, 1e300}); // none is lost
    CHECK(drawn(far)[0] > 0);
    CHECK(drawn(far)[0] < 1e-6);
}
