// The pixel filters.
#include "stats/hypothesis.h"
#include "support/checks.h"
#include "support/pictures.h"
#include "support/rooms.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace opal::test {

namespace {

struct NamedFilter {
    std::string name;
    Filter filter;
    std::function<double(double)> weight; // of a distance
};

double mitchell(double x, double b, double c) { // Mitchell and Netravali 1988, radius 2
    const double t = std::abs(x);
    if (t >= 2)
        return 0;
    return t < 1 ? ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + 6 - 2 * b) / 6
                 : ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t + (-12 * b - 48 * c) * t + 8 * b + 24 * c) / 6;
}

double sinc(double x) { return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x); }

constexpr int reach = 3; // pixels to each side, of the widest

std::vector<NamedFilter> filters() {
    return {
        {"box", Filter{FILTER_box, 0.5}, [](double x) { return std::abs(x) <= 0.5 ? 1.0 : 0.0; }},
        {"tent", Filter{FILTER_tent, 1}, [](double x) { return std::max(0.0, 1 - std::abs(x)); }},
        {"gaussian", Filter{FILTER_gaussian, 2, 0.5},
         [](double x) { return std::abs(x) < 2 ? std::exp(-2 * x * x) - std::exp(-8.0) : 0.0; }},
        {"mitchell", Filter{FILTER_mitchell, 2}, [](double x) { return mitchell(x, 1.0 / 3, 1.0 / 3); }},
        {"catmullrom", Filter{FILTER_mitchell, 2, 0, 0, 0.5}, [](double x) { return mitchell(x, 0, 0.5); }},
        {"lanczos", Filter{FILTER_lanczos, 3}, [](double x) { return std::abs(x) < 3 ? sinc(x) * sinc(x / 3) : 0.0; }}};
}

double integral(const std::function<double(double)> &f, double from, double to) {
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; i++)
        sum += f(from + (to - from) * (i + 0.5) / steps);
    return sum * (to - from) / steps;
}

constexpr int width = 16, height = 606, middle = width / 2;

// A wall that emits 1, seen head-on; its edge runs down the image at column `edge`, bright on the left.
SceneDescription half_lit(double edge) {
    // Film x = (1 - 2 sx) tan(fov / 2) at distance 1, +x left: with a half angle of 45 degrees and depth 1 from 1 to
    // -1.
    const double x = 1 - 2 * edge / width;
    SceneDescription scene = scene_of({light(Parallelogram{{x, -90, 1}, {0, 180, 0}, {50, 0, 0}}, {1, 1, 1})});
    scene.meshes[0].bsdf = diffuse(0);
    scene.camera.width = width;
    scene.camera.height = height;
    scene.camera.perspective.fov = 90;
    scene.strategy.max_depth = 1;
    return scene;
}

Film filtered(SceneDescription scene, const Filter &filter, unsigned spp, unsigned seed, const Sources &sources) {
    scene.camera.filter = filter;
    scene.spp = spp;
    RenderSetup setup;
    setup.sources = &sources;
    return render(with_strategy(std::move(scene), {{"lighting", "bsdf"}, {"rr", "off"}, {"sampler", "stratified"}}),
                  spp, seed, setup);
}

double value(const Film &film, int x, int y) {
    const size_t p = size_t(y) * size_t(film.width) + size_t(x);
    return film.weighted.empty() ? film.sum[p][0] / film.count[p] : film.weighted[p][0] / film.weighted[p][3];
}

// f of rows far enough apart to share no sample.
template <class F> stats::Sample over_rows(const Film &film, F f) {
    stats::Moments moments;
    for (int y = reach; y + reach < film.height; y += 2 * reach)
        moments.add(f(y));
    return moments.sample();
}

} // namespace

Findings check_filters(const Sources &sources, unsigned seed) {
    Findings findings;
    constexpr unsigned spp = 256;
    for (const NamedFilter &f : filters()) {
        const Film lit = filtered(half_lit(width + 20), f.filter, spp, seed, sources);
        bool constant = lit.invalid == 0;
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                constant = constant && std::abs(value(lit, x, y) - 1) < 1e-6;
        findings.push_back(exact(f.name + ": a constant picture stays constant, to its borders", constant));

        const double edge = middle + 0.3;
        const Film film = filtered(half_lit(edge), f.filter, spp, seed + 1, sources);
        const double radius = f.filter.radius; // beyond, a box would have a step within the sum of the integral
        const double whole = integral(f.weight, -radius, radius);
        if (!film.weighted.empty()) // a pixel gets the weights of all samples around it
            findings.push_back(p_value(
                f.name + ": the weights' sum",
                stats::t_test(over_rows(film,
                                        [&](int y) {
                                            double sum = 0;
                                            for (int x = reach; x + reach < width; x += 2 * reach)
                                                sum += film.weighted[size_t(y) * width + size_t(x)][3] / spp / 2;
                                            return sum;
                                        }),
                              whole * whole)
                    .p_value));
        for (int x = middle - 3; x <= middle + 3; x++) {
            const double lit_share = integral(f.weight, -radius, std::clamp(edge - (x + 0.5), -radius, radius)) / whole;
            findings.push_back(
                p_value(f.name + ": edge at column " + std::to_string(x),
                        stats::t_test(over_rows(film, [&](int y) { return value(film, x, y); }), lit_share).p_value));
        }
    }
    return findings;
}

} // namespace opal::test
