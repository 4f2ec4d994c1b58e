// A render's samples do not depend on how they are cut into passes and launches, nor on where a render was stopped.
#include "support/device.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/seeds.h"

#include <cmath>
#include <cstring>

using namespace opal;
using namespace opal::test;

namespace {

template <class T> bool same_bits(const std::vector<T> &a, const std::vector<T> &b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool same_bits(const Film &a, const Film &b) {
    return same_bits(a.sum, b.sum) && same_bits(a.squares, b.squares) && same_bits(a.weighted, b.weighted) &&
           same_bits(a.count, b.count);
}

Film in_passes(const SceneDescription &scene, unsigned spp, unsigned most) {
    RenderSetup setup;
    setup.max_pass_samples = most;
    return render(scene, spp, test_seed(20), setup);
}

} // namespace

TEST_CASE("Passes cut differently give the same bits", "[passes]") {
    for (const auto &[sampler, filter] :
         {std::pair{"independent", Filter{}}, {"stratified", Filter{FILTER_gaussian, 2, 0.5}}, {"sobol", Filter{}}}) {
        SceneDescription scene = with_strategy(gallery(13, 9), {{"sampler", sampler}});
        scene.camera.filter = filter;
        scene.spp = 23;
        const Film whole = in_passes(scene, 23, 0);
        CHECK(whole.invalid == 0);
        for (unsigned most : {1u, 3u, 7u}) {
            INFO(sampler << " in passes of " << most);
            CHECK(same_bits(whole, in_passes(scene, 23, most)));
        }
    }
}

TEST_CASE("The same command gives the same bits, another seed does not", "[passes]") {
    const SceneDescription scene = gallery(13, 9);
    Renderer renderer = renderer_of(scene);
    std::vector<Film> films;
    for (unsigned seed : {7u, 8u, 7u}) {
        renderer.restart(seed);
        renderer.render(5);
        films.push_back(renderer.film());
    }
    CHECK(same_bits(films[0], films[2]));
    CHECK_FALSE(same_bits(films[0].sum, films[1].sum));
}

TEST_CASE("Samples rendered in two goes are those of one", "[passes]") {
    const SceneDescription scene = gallery(13, 9);
    Renderer renderer = renderer_of(scene);
    renderer.restart(3);
    renderer.render(4);
    CHECK(renderer.next_sample() == 4);
    renderer.render(11);
    CHECK(same_bits(renderer.film(), render(scene, 11, 3)));
}

TEST_CASE("A first pass that is stopped has its samples all over the image", "[passes]") {
    SceneDescription large = with_strategy(gallery(1200, 1200), {{"integrator", "normals"}});
    Renderer renderer = renderer_of(large);
    renderer.restart(1);
    if (renderer.render(1, [](double samples, double) { return samples < 0.25; })) {
        WARN("not tested: one launch holds the whole image here");
        return;
    }
    const Film film = renderer.film();
    const size_t pixels = film.count.size();
    const FilmStatistics statistics = statistics_of(film);
    CHECK(statistics.samples + statistics.empty_pixels == pixels);
    CHECK(double(statistics.empty_pixels) / double(pixels) == Approx(0.75).margin(0.03));
    size_t sampled[4][4] = {};
    for (size_t p = 0; p < pixels; p++)
        sampled[p / 1200 / 300][p % 1200 / 300] += film.count[p];
    for (const auto &row : sampled)
        for (const size_t n : row)
            CHECK(double(n) / (300 * 300) == Approx(0.25).margin(0.15));
    CHECK(statistics.mean_luminance == Approx(statistics_of(render(large, 1, 1)).mean_luminance).epsilon(0.05));
}

// The image is large enough for several launches a pass, so that a pass can stop in its middle.
TEST_CASE("A render that is stopped midway holds the first samples of each pixel, and counts them", "[passes]") {
    SceneDescription large = with_strategy(furnace(0.5, 1), {{"integrator", "normals"}});
    large.camera = camera({0.1, 0.2, -0.3}, {0.3, 0, 1}, 256, 200, 70);
    Renderer renderer = renderer_of(large);
    const unsigned seed = test_seed(21);
    renderer.restart(seed);
    double done = 0;
    CHECK_FALSE(renderer.render(1000, [&](double samples, double) {
        done = samples;
        return samples < 2 || samples == std::floor(samples);
    }));
    const Film stopped = renderer.film();
    CHECK(stopped.invalid == 0);

    // Every pixel holds samples 0 .. count - 1, and so the sums of a render of that many.
    const auto [least, most] = std::minmax_element(stopped.count.begin(), stopped.count.end());
    REQUIRE(*most > 0);
    CHECK(*least < *most);
    std::vector<unsigned> counts = stopped.count;
    std::sort(counts.begin(), counts.end());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    REQUIRE(counts.size() < 8);
    size_t wrong = 0;
    for (unsigned count : counts) {
        const Film whole = count ? render(large, count, seed) : stopped;
        for (size_t p = 0; p < stopped.count.size(); p++)
            if (stopped.count[p] == count)
                wrong += count ? stopped.sum[p] != whole.sum[p] || stopped.squares[p] != whole.squares[p]
                               : stopped.sum[p] != std::array<double, 3>{};
    }
    CHECK(wrong == 0);

    unsigned long long samples = 0;
    for (unsigned n : stopped.count)
        samples += n;
    const FilmStatistics statistics = statistics_of(stopped);
    CHECK(statistics.samples == samples);
    CHECK(double(samples) / double(stopped.count.size()) == Approx(done).epsilon(0.05));
    // The mean is over the pixels that have samples: those without do not darken it.
    const FilmStatistics full = statistics_of(render(large, 4, seed));
    CHECK(statistics.mean_luminance == Approx(full.mean_luminance).epsilon(0.2));
}
