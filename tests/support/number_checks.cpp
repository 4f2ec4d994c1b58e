// The random numbers: known values, strata, elementary intervals, independence.
#include "stats/hypothesis.h"
#include "support/kernel_checks.h"
#include "support/kernels.h"
#include "support/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

namespace opal::test {

namespace {

KernelProbe probe_at(int lanes, const Sources &sources) { return probe_of(scene_of_bsdfs({}), lanes, sources); }

unsigned bits24(float u) { return unsigned(std::ldexp(double(u), 24)); } // exact: every number is k 2^-24

struct KnownNumbers {
    unsigned index;       // sample 3 index of pixel 7 index, seed 42
    unsigned pairs[3][2]; // of dimensions 4, 5, 6, times 2^24
};

// Computed in integers by a separate program from the papers' definitions (pcg3d, pcg4d, Sobol's second dimension by
// its direction numbers, Laine-Karras with Vegdahl's constants).
constexpr KnownNumbers independent_numbers[] = {
    {0, {{6313979, 10456319}, {4572304, 13315532}, {11795585, 12854500}}},
    {1, {{1980249, 9935642}, {13202335, 2018448}, {7277339, 6906205}}},
    {1000, {{5793495, 7366603}, {16207522, 12532365}, {3660511, 12038522}}}};
constexpr KnownNumbers sobol_numbers[] = {{0, {{8323467, 6357171}, {7829070, 6918955}, {10348780, 13447596}}},
                                          {1, {{3570071, 6700649}, {9709999, 621273}, {9936181, 4669739}}},
                                          {1000, {{14118383, 12703861}, {8826045, 12664601}, {15062492, 5168681}}}};

bool has(const Planes &numbers, const KnownNumbers &known) {
    bool same = true;
    for (size_t pair = 0; pair < 3; pair++)
        for (size_t i = 0; i < 2; i++)
            same = same && bits24(numbers.at(2 * pair + i, known.index)) == known.pairs[pair][i];
    return same;
}

bool below_one(const Planes &numbers) {
    for (size_t plane = 0; plane < 2 * OPAL_PROBE_PAIRS; plane++)
        for (size_t i = 0; i < numbers.count; i++)
            if (!(numbers.at(plane, i) >= 0 && numbers.at(plane, i) < 1))
                return false;
    return true;
}

// The keys of the dimensions of `count` segments from `first` on, in their order.
struct DimensionKeys {
    std::vector<uint> old, added;
};
DimensionKeys keys_of_segments(const Sources &sources, uint first, uint count) {
    const std::string text =
        "#include \"core/lanes.cl\"\n#include \"core/rng.cl\"\n"
        "kernel void sizes(global uint *out) { out[0] = DIMS_A_SEGMENT; out[1] = ADDED_A_SEGMENT; }\n"
        "kernel void keys(uint first, global uint *old, global uint *added) {\n"
        "    uint i = (uint)get_global_id(0);\n"
        "    for (uint n = 0; n < DIMS_A_SEGMENT; n++)\n"
        "        old[i * DIMS_A_SEGMENT + n] = segment_dimension(first + i, n);\n"
        "    for (uint n = 0; n < ADDED_A_SEGMENT; n++)\n"
        "        added[i * ADDED_A_SEGMENT + n] = segment_dimension(first + i, ADDED_DIMENSION + n);\n"
        "}\n";
    const cl::Program program = program_from(sources, text, 1);
    const Output<uint> sizes(2);
    run(program, "sizes", 1, sizes);
    const Output<uint> old(count * sizes.read()[0]), added(count * sizes.read()[1]);
    run(program, "keys", count, first, old, added);
    return {old.read(), added.read()};
}

Finding uncorrelated(const std::string &what, const Planes &a, size_t plane_a, const Planes &b, size_t plane_b,
                     size_t shift = 0) {
    double sum = 0;
    const size_t n = a.count - shift;
    for (size_t i = 0; i < n; i++)
        sum += (double(a.at(plane_a, i)) - 0.5) * (double(b.at(plane_b, i + shift)) - 0.5);
    const double variance = 1.0 / 144; // of a product of two numbers
    return p_value(what, stats::two_sided_p(sum / double(n) / std::sqrt(variance / double(n)), INFINITY));
}

// 16 x 16 cells of pairs.
Finding uniform_pairs(const std::string &what, const Planes &a, size_t plane_a, const Planes &b, size_t plane_b,
                      size_t shift = 0) {
    std::vector<double> observed(256);
    const size_t n = a.count - shift;
    for (size_t i = 0; i < n; i++)
        observed[size_t(a.at(plane_a, i) * 16) * 16 + size_t(b.at(plane_b, i + shift) * 16)]++;
    return p_value(what, stats::chi_square_test(observed, std::vector<double>(256, double(n) / 256)).p_value);
}

} // namespace

Findings check_known_numbers(const Sources &sources, unsigned) {
    Findings findings;
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_at(lanes, sources);
        NumberOptions options;
        options.seed = 42;
        options.first_dimension = 4;
        options.pixel_step = 7;
        options.sample_step = 3;
        const std::string where = at_width(lanes);
        const Planes independent = probe.numbers(1001, options);
        for (const KnownNumbers &known : independent_numbers)
            findings.push_back(
                exact("independent numbers of index " + std::to_string(known.index) + where, has(independent, known)));
        options.sampler = CHOICE_sampler_sobol;
        const Planes sobol = probe.numbers(1001, options);
        for (const KnownNumbers &known : sobol_numbers)
            findings.push_back(
                exact("Sobol numbers of index " + std::to_string(known.index) + where, has(sobol, known)));
        // Every sampler, also with awkward numbers of strata, stays below 1.
        for (int sampler : {CHOICE_sampler_independent, CHOICE_sampler_stratified, CHOICE_sampler_sobol})
            for (unsigned spp : {1u, 7u, 1000u, 65521u}) {
                options.sampler = sampler;
                options.spp = spp;
                findings.push_back(exact("below 1" + where, below_one(probe.numbers(1 << 16, options))));
            }
    }
    const std::string text =
        "#include \"core/lanes.cl\"\n#include \"core/math.cl\"\n#include \"core/rng.cl\"\n"
        "kernel void largest(global float *out) { out[0] = unit_real(0xffffffffu); out[1] = unit_real(0u); }\n";
    const cl::Program program = program_from(sources, text, 1);
    const Output<float> out(2);
    run(program, "largest", 1, out);
    findings.push_back(exact("all bits set is 1 - 2^-24", out.read() == std::vector<float>{0x1.fffffep-1f, 0}));
    return findings;
}

Findings check_sobol(const Sources &sources, unsigned seed) {
    Findings findings;
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_at(lanes, sources);
        NumberOptions options;
        options.sampler = CHOICE_sampler_sobol;
        for (unsigned pixel = 0; pixel < 4; pixel++) {
            // A pixel step of 0: the index counts the samples of one pixel. Other pixels are other seeds.
            options.seed = seed + pixel;
            const Planes numbers = probe.numbers(1024, options);
            for (size_t pair = 0; pair < OPAL_PROBE_PAIRS; pair++)
                for (int power :
                     {4, 8, 10}) // the first 2^power points and each later block of as many are (0, power, 2)-nets
                    for (int a = 0; a <= power; a++) {
                        bool net = true;
                        for (size_t block = 0; block < 1024u >> power && net; block++) {
                            std::set<unsigned> cells;
                            for (size_t i = block << power; i < (block + 1) << power; i++)
                                cells.insert(bits24(numbers.at(2 * pair, i)) >> (24 - a) << (power - a) |
                                             bits24(numbers.at(2 * pair + 1, i)) >> (24 - power + a));
                            net = cells.size() == 1u << power;
                        }
                        findings.push_back(exact("a point in each interval of 2^-" + std::to_string(a) + " x 2^-" +
                                                     std::to_string(power - a),
                                                 net));
                    }
        }
    }
    return findings;
}

Findings check_stratified(const Sources &sources, unsigned seed) {
    Findings findings;
    struct Strata {
        unsigned spp, columns, rows;
    };
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_at(lanes, sources);
        for (const auto &[spp, columns, rows] : {Strata{16, 4, 4}, {12, 3, 4}, {7, 2, 4}, {256, 16, 16}, {1, 1, 1}}) {
            NumberOptions options;
            options.sampler = CHOICE_sampler_stratified;
            options.spp = spp;
            options.seed = seed;
            const Planes numbers = probe.numbers(2 * columns * rows, options); // past spp the strata start over
            std::set<std::vector<unsigned>> orders;
            for (size_t pair = 0; pair < OPAL_PROBE_PAIRS; pair++)
                for (unsigned round = 0; round < 2; round++) {
                    std::vector<unsigned> order;
                    for (size_t i = round * columns * rows; i < (round + 1) * columns * rows; i++)
                        order.push_back(unsigned(double(numbers.at(2 * pair, i)) * columns) * rows +
                                        unsigned(double(numbers.at(2 * pair + 1, i)) * rows));
                    findings.push_back(exact("each of " + std::to_string(columns * rows) + " strata once",
                                             std::set<unsigned>(order.begin(), order.end()).size() == order.size()));
                    orders.insert(order);
                }
            if (spp >= 12)
                findings.push_back(exact("each dimension and round in an order of its own", orders.size() == 6));
        }
    }
    // Where there are more strata than samples, all strata are left out equally often. The samples past spp of a round
    // fall into those that were left out.
    KernelProbe probe = probe_at(tested_lanes().back(), sources);
    for (unsigned spp : {11u, 17u, 18u, 19u, 21u, 22u, 23u, 37u, 43u}) {
        const unsigned columns = unsigned(std::sqrt(double(spp))), rows = (spp + columns - 1) / columns,
                       cells = columns * rows;
        NumberOptions options;
        options.sampler = CHOICE_sampler_stratified;
        options.spp = spp;
        options.seed = seed;
        const Planes numbers = probe.numbers(size_t(cells) << 17, options);
        for (size_t pair = 0; pair < OPAL_PROBE_PAIRS; pair++) {
            std::vector<double> left_out(cells), by_column(columns), by_row(rows);
            for (size_t i = 0; i < numbers.count; i++) {
                if (i % cells < spp)
                    continue;
                const unsigned column = unsigned(double(numbers.at(2 * pair, i)) * columns),
                               row = unsigned(double(numbers.at(2 * pair + 1, i)) * rows);
                left_out[row * columns + column]++;
                by_column[column]++;
                by_row[row]++;
            }
            for (const std::vector<double> &counts : {left_out, by_column, by_row}) {
                const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
                findings.push_back(p_value(
                    fmt::format("strata left out alike at {} samples", spp),
                    stats::chi_square_test(counts, std::vector<double>(counts.size(), all / double(counts.size())))
                        .p_value));
            }
        }
    }
    return findings;
}

Findings check_dimensions(const Sources &sources, unsigned) {
    constexpr uint segments = 4096, last = 1 << 28; // the first ones, and the last ones that have keys of their own
    const DimensionKeys first = keys_of_segments(sources, 1, segments),
                        end = keys_of_segments(sources, last - segments, segments),
                        camera = keys_of_segments(sources, 0, 1);
    std::set<uint> distinct = {0}, low_bits; // 0: of the film
    size_t all = 1;
    for (const std::vector<uint> *keys : {&first.old, &first.added, &end.old, &end.added, &camera.added}) {
        distinct.insert(keys->begin(), keys->end());
        all += keys->size();
    }
    for (const std::vector<uint> *keys : {&first.old, &first.added, &camera.added})
        for (uint key : *keys)
            low_bits.insert(key & 0x7fffffffu);
    bool known = true; // the keys of older pictures
    for (uint i = 0; i < first.old.size(); i++)
        known = known && first.old[i] == 1 + i;
    const auto is_marked = [](uint key) { return key >> 31 == 1; };
    return {
        exact("keys are distinct", distinct.size() == all),
        exact("keys of the first segments differ not in the highest bit alone",
              low_bits.size() == first.old.size() + first.added.size() + camera.added.size()),
        exact("old dimensions have their keys", known && first.old.size() == 5 * segments),
        exact("added dimensions have the highest bit", std::all_of(end.added.begin(), end.added.end(), is_marked) &&
                                                           std::none_of(end.old.begin(), end.old.end(), is_marked))};
}

Findings check_independence(const Sources &sources, unsigned seed) {
    Findings findings;
    constexpr size_t count = 1 << 16;
    KernelProbe probe = probe_at(device().info.native_lanes, sources);
    const DimensionKeys camera = keys_of_segments(sources, 0, 1), segment = keys_of_segments(sources, 1, 1);
    for (int sampler : {CHOICE_sampler_independent, CHOICE_sampler_stratified, CHOICE_sampler_sobol}) {
        const std::string name = axes()[AXIS_sampler].choices[size_t(sampler)].name + ": ";
        NumberOptions options;
        options.sampler = sampler;
        options.seed = seed;
        options.spp = 16;
        // One sample of each pixel: numbers of neighbouring pixels look independent, whatever the sampler.
        options.sample_step = 0;
        options.pixel_step = 1;
        const Planes pixels = probe.numbers(count, options);
        options.seed = seed + 1;
        const Planes other_seed = probe.numbers(count, options);
        std::vector<double> values(pixels.values.begin(), pixels.values.begin() + count);
        findings.push_back(p_value(name + "uniform over pixels", stats::ks_uniform_test(values).p_value));
        for (size_t shift : {1u, 2u, 16u, 400u}) {
            findings.push_back(
                uncorrelated(name + "pixels " + std::to_string(shift) + " apart", pixels, 0, pixels, 0, shift));
            findings.push_back(uniform_pairs(name + "pairs of pixels", pixels, 1, pixels, 1, shift));
        }
        for (size_t plane : {1u, 2u, 3u, 5u}) {
            findings.push_back(uncorrelated(name + "dimensions", pixels, 0, pixels, plane));
            findings.push_back(uniform_pairs(name + "pairs of dimensions", pixels, 0, pixels, plane));
        }
        options.seed = seed;
        std::vector<Planes> added;
        for (uint key : {camera.added[0], camera.added[1], segment.added[0]}) {
            options.first_dimension = key;
            added.push_back(probe.numbers(count, options));
        }
        options.first_dimension = 0;
        for (size_t i = 0; i < added.size(); i++) {
            std::vector<double> first(added[i].values.begin(), added[i].values.begin() + count);
            findings.push_back(p_value(name + "added dimension uniform", stats::ks_uniform_test(first).p_value));
            findings.push_back(uniform_pairs(name + "pairs of an added dimension", added[i], 0, added[i], 1));
            findings.push_back(uncorrelated(name + "added dimensions", added[i], 0, added[(i + 1) % 3], 0));
            findings.push_back(uniform_pairs(name + "pairs of added dimensions", added[i], 0, added[(i + 1) % 3], 0));
            for (size_t plane = 0; plane < 2 * OPAL_PROBE_PAIRS; plane++) {
                findings.push_back(uncorrelated(name + "an added dimension and others", pixels, plane, added[i], 0));
                findings.push_back(uniform_pairs(name + "pairs with an added dimension", pixels, plane, added[i], 1));
            }
        }
        findings.push_back(uncorrelated(name + "seeds", pixels, 0, other_seed, 0));
        findings.push_back(uniform_pairs(name + "pairs of seeds", pixels, 0, other_seed, 0));
        if (sampler != CHOICE_sampler_independent)
            continue;
        options.sample_step = 1;
        options.pixel_step = 0;
        const Planes samples = probe.numbers(count, options);
        findings.push_back(uncorrelated(name + "samples", samples, 0, samples, 0, 1));
        findings.push_back(uniform_pairs(name + "pairs of samples", samples, 0, samples, 0, 1));
    }
    return findings;
}

} // namespace opal::test
