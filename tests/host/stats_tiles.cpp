// The test of images: one picture's estimates pass as often as stated, a small or a local bias is found and named.
#include "stats/tiles.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace opal::stats;

namespace {

constexpr int width = 60, height = 44, spp = 16; // the last tiles are cut
constexpr double level = 1e-3;

struct Picture {
    std::vector<std::vector<float>> mean, variance;
    Estimate estimate() const {
        Estimate e{width, height, {}, {}, spp, spp - 1};
        e.mean.assign(mean.begin(), mean.end());
        e.variance.assign(variance.begin(), variance.end());
        return e;
    }
};

// Brightness falls by 1e6 from left to right; gamma-distributed samples, standard deviation 1/2 of the mean.
double truth(int x) { return std::pow(10.0, -6.0 * x / width); }

template <class Bias> Picture render(unsigned seed, Bias bias) {
    std::mt19937_64 rng(seed);
    std::gamma_distribution<double> gamma(4, 0.25);
    Picture picture;
    for (int channel = 0; channel < 2; ++channel) {
        picture.mean.emplace_back();
        picture.variance.emplace_back();
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                Moments m;
                for (int i = 0; i < spp; ++i)
                    m.add(gamma(rng) * truth(x) * (1 + bias(channel, x, y)));
                picture.mean.back().push_back(float(m.mean()));
                picture.variance.back().push_back(float(m.variance_of_mean()));
            }
    }
    return picture;
}

Picture render(unsigned seed) {
    return render(seed, [](int, int, int) { return 0.0; });
}

} // namespace

TEST_CASE("two estimates of one picture agree as often as stated", "[stats_tiles]") {
    int rejected = 0, doubled = 0;
    std::vector<double> whole;
    for (unsigned seed = 0; seed < 100; ++seed) {
        Picture a = render(2 * seed), b = render(2 * seed + 1);
        TileTest t = tile_test(a.estimate(), b.estimate());
        rejected += t.rejected(0.05);
        whole.push_back(t.whole[0].p_value);
        for (Picture *p : {&a, &b}) // the negative control: half the variance
            for (auto &layer : p->variance)
                for (float &v : layer)
                    v /= 2;
        doubled += tile_test(a.estimate(), b.estimate()).rejected(0.05);
    }
    CHECK_FALSE(binomial_test(rejected, 100, 0.05).rejected(level));
    CHECK(binomial_test(doubled, 100, 0.05).rejected(level));
    CHECK_FALSE(ks_uniform_test(whole).rejected(level));
}

TEST_CASE("a bias of 2 % everywhere is seen by the whole", "[stats_tiles]") {
    Picture a = render(1000), b = render(1001, [](int, int, int) { return 0.02; });
    TileTest t = tile_test(a.estimate(), b.estimate());
    CHECK(t.rejected(level));
    CHECK(t.whole[0].rejected(level));
}

TEST_CASE("a bias in a dark corner is found and named", "[stats_tiles]") {
    auto corner = [](int channel, int x, int y) {
        return channel == 1 && x >= 40 && x < 56 && y >= 8 && y < 24 ? 0.3 : 0;
    };
    Picture a = render(2000), b = render(2001, corner);
    TileTest t = tile_test(a.estimate(), b.estimate());
    CHECK(t.rejected(level));
    CHECK_FALSE(t.whole[1].rejected(level)); // 1e-4 of the light: the whole cannot know
    CHECK(t.columns == 8);
    CHECK(t.rows == 6);
    CHECK(t.worst_channel == 1);
    CHECK(t.worst_z < -5);
    CHECK(t.region.channel == 1);
    CHECK(t.region.tiles == 4);
    CHECK(t.region.box.x == 40);
    CHECK(t.region.box.y == 8);
    CHECK(t.region.box.width == 16);
    CHECK(t.region.box.height == 16);
    CHECK(t.region.mean_b / t.region.mean_a == Approx(1.3).epsilon(0.05));
    CHECK(t.region.statistic < -10);
}

TEST_CASE("a variance of 0 has a relative floor", "[stats_tiles]") {
    Picture a = render(3000);
    for (int channel = 0; channel < 2; ++channel)
        for (int i = 0; i < width * height; ++i) {
            a.mean[channel][i] = float(truth(i % width));
            a.variance[channel][i] = 0;
        }
    Picture same = a, off = a;
    CHECK(tile_test(a.estimate(), same.estimate()).p_value == 1);
    for (int i = 0; i < width * height; ++i)
        if (i % width >= 56) // the darkest column of tiles, 1e-6 of the brightest
            off.mean[0][i] *= 1.001f;
    TileTest t = tile_test(a.estimate(), off.estimate());
    CHECK(t.rejected(level));
    CHECK(t.worst_tile.x == 56);
    CHECK(t.region.tiles == 6);
}

TEST_CASE("light by rare samples is no difference", "[stats_tiles]") {
    // One sample in 5000 is 1, the others 0: 16 samples a pixel mostly miss a tile, 4096 do not.
    auto rare = [](unsigned seed, int samples, double p) {
        std::mt19937_64 rng(seed);
        std::binomial_distribution<int> hits(samples, p);
        Picture picture;
        picture.mean.resize(1), picture.variance.resize(1);
        for (int i = 0; i < width * height; ++i) {
            double mean = double(hits(rng)) / samples;
            picture.mean[0].push_back(float(mean));
            picture.variance[0].push_back(float(mean * (1 - mean) / (samples - 1)));
        }
        return picture;
    };
    auto estimate = [](const Picture &p, double samples, bool counts_known = true) {
        Estimate e = p.estimate();
        e.samples = counts_known ? samples : 0, e.dof = samples - 1;
        return e;
    };
    TileOptions naive;
    naive.sure_hits = 0;
    int rejected = 0, borrowed = 0, quantum = 0, unaided = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        Picture few = rare(2 * seed, 16, 2e-4), many = rare(2 * seed + 1, 4096, 2e-4);
        rejected += tile_test(estimate(few, 16), estimate(many, 4096)).rejected(0.05);
        borrowed += tile_test(estimate(few, 16), estimate(many, 4096), naive).rejected(0.05);
        quantum += tile_test(estimate(few, 16, false), estimate(many, 4096, false)).rejected(0.05);
        unaided += tile_test(estimate(few, 16, false), estimate(many, 4096, false), naive).rejected(0.05);
    }
    CAPTURE(rejected, borrowed, quantum);
    CHECK(binomial_test(rejected, 60, 0.05).p_value > level);
    CHECK(binomial_test(borrowed, 60, 0.05).p_value > level);
    CHECK(binomial_test(quantum, 60, 0.05).p_value > level);
    CHECK(unaided == 60); // the negative control: what the rule is for
    Picture dark = rare(1, 256, 2e-4), bright = rare(2, 4096, 4e-4);
    CHECK(tile_test(estimate(dark, 256), estimate(bright, 4096)).rejected(level));
}

TEST_CASE("rare light on top of light without noise is no difference, a deficit of common light is", "[stats_tiles]") {
    // Hits of 1 everywhere, rare ones in the first tile, whose pixels are a lamp of 0.4 besides.
    auto lamp = [](unsigned seed, int samples, double sure) {
        std::mt19937_64 rng(seed);
        std::binomial_distribution<int> common(samples, 0.02), rare(samples, 2e-5);
        Picture picture;
        picture.mean.resize(1), picture.variance.resize(1);
        for (int i = 0; i < width * height; ++i) {
            const bool tile = i % width < 8 && i / width < 8;
            const double mean = double((tile ? rare : common)(rng)) / samples;
            picture.mean[0].push_back(float(mean + (tile ? sure : 0)));
            picture.variance[0].push_back(float(mean * (1 - mean) / (samples - 1)));
        }
        return picture;
    };
    auto rejects = [](const Picture &a, const Picture &b, double sure_hits) {
        Estimate x = a.estimate(), y = b.estimate();
        x.samples = y.samples = 0, x.dof = 255, y.dof = 65535;
        return tile_test(x, y, TileOptions{.sure_hits = sure_hits}).rejected(0.05);
    };
    int rejected = 0, unaided = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        const Picture few = lamp(2 * seed, 256, 0.4), many = lamp(2 * seed + 1, 65536, 0.4);
        rejected += rejects(few, many, TileOptions{}.sure_hits);
        unaided += rejects(few, many, 0);
    }
    CAPTURE(rejected, unaided);
    CHECK(binomial_test(rejected, 60, 0.05).p_value > level);
    CHECK(unaided > 30); // the negative control
    CHECK(rejects(lamp(1, 256, 0.4), lamp(2, 65536, 0.42), TileOptions{}.sure_hits));
}

TEST_CASE("NaN, negative variances and images that don't fit are rejected", "[stats_tiles]") {
    Picture a = render(4000), b = render(4001);
    for (float bad : {NAN, INFINITY}) {
        Picture c = b;
        c.mean[1][width * 20 + 33] = bad;
        TileTest t = tile_test(a.estimate(), c.estimate());
        CHECK(t.p_value == 0);
        CHECK(t.worst_channel == 1);
        CHECK(t.worst_tile.x == 32);
        CHECK(t.worst_tile.y == 16);
    }
    for (float bad : {NAN, -1.0f}) {
        Picture c = b;
        c.variance[0][5] = bad;
        CHECK(tile_test(a.estimate(), c.estimate()).p_value == 0);
    }
    Estimate smaller = b.estimate(), fewer = b.estimate(), bare = b.estimate(), single = b.estimate();
    smaller.height -= 1;
    fewer.mean.pop_back(), fewer.variance.pop_back();
    bare.variance.clear();
    single.dof = 0;
    for (const Estimate &e : {smaller, fewer, bare, Estimate{}}) {
        CHECK(tile_test(a.estimate(), e).p_value == 0);
        CHECK_FALSE(tile_test(a.estimate(), e).reason.empty());
    }
    CHECK(tile_test(a.estimate(), single).p_value == 0);
}
