#include "sweep/measure.h"

#include "base/signals.h"

#include <algorithm>
#include <cmath>

namespace opal {

Measured::Measured(const Device &device, const Candidate &candidate, const Sources &sources, int lanes)
    : device_(device), candidate_(candidate), sources_(sources), lanes_(lanes) {
    compile(candidate.scene.spp);
}

void Measured::compile(unsigned spp) {
    SceneDescription scene = candidate_.scene;
    scene.spp = compiled_spp_ = spp;
    renderer_.reset();
    flat_ = std::make_unique<FlatScene>(flatten(scene, lanes_));
    RenderOptions options;
    options.build = {.lanes = lanes_, .math = scene.strategy.math, .kernels = "kernels/render.cl"};
    options.sources = &sources_;
    renderer_ = std::make_unique<Renderer>(device_, *flat_, options);
}

Measured::Rendered Measured::render(unsigned spp, unsigned seed, unsigned first) {
    if (candidate_.scene.strategy[AXIS_sampler] == CHOICE_sampler_stratified && spp != compiled_spp_)
        compile(spp);
    renderer_->restart(seed, first);
    if (!renderer_->render(first + spp, [](double, double) { return !interrupted(); }))
        throw Interrupted{};
    Rendered rendered{renderer_->film(), {}, renderer_->kernel_seconds()};
    rendered.image = image_of(rendered.film, false);
    return rendered;
}

namespace {

double luminance(double r, double g, double b) { return 0.212671 * r + 0.715160 * g + 0.072169 * b; }

// Mean over the pixels of variance / (mean^2 + floor), of single samples.
double relative_variance(const Film &film) {
    const FilmStatistics s = statistics_of(film);
    const double floor = 0.01 * s.mean_luminance;
    double sum = 0;
    for (size_t p = 0; p < film.sum.size(); p++) {
        const double n = film.count[p], y = luminance(film.sum[p][0], film.sum[p][1], film.sum[p][2]);
        if (n < 2)
            continue;
        const double mean = y / n, scale = mean * mean + floor * floor;
        sum += scale > 0 ? std::fmax(0, film.squares[p][3] - y * mean) / (n - 1) / scale : 0;
    }
    return sum / double(film.sum.size());
}

} // namespace

Pilot run_pilot(Measured &measured, unsigned seed, double seconds) {
    unsigned spp = 8;
    Measured::Rendered r = measured.render(spp, seed, pilot_first);
    while (r.seconds < seconds / 2 && spp < 1u << 16) {
        spp = unsigned(std::clamp(seconds / std::fmax(r.seconds, 1e-9) * spp, 2.0 * spp, 8.0 * spp));
        r = measured.render(spp, seed, pilot_first);
    }
    return {relative_variance(r.film) * r.seconds / spp, r.seconds / spp};
}

} // namespace opal
