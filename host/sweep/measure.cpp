#include "sweep/measure.h"

#include "base/error.h"
#include "base/signals.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

namespace opal {

CompiledStrategy::CompiledStrategy(const Device &device, const Candidate &candidate, const Sources &sources,
                                   Clock clock)
    : label_(candidate.label), strategy_(candidate.scene.strategy), clock_(clock),
      cores_(std::max(1u, device.info.compute_units)), lanes_(lanes_for(device.info, strategy_.lanes, strategy_.math)) {
    RenderOptions options;
    options.build = {.lanes = lanes_, .math = strategy_.math, .kernels = "kernels/render.cl"};
    options.sources = &sources;
    renderer_ = std::make_unique<Renderer>(device, flatten(candidate.scene, lanes_), options);
}

CompiledStrategy::RenderResult CompiledStrategy::render(unsigned spp, unsigned seed, unsigned first,
                                                        double most_seconds) {
    renderer_->plan_samples(spp);
    renderer_->restart(seed, first);
    const std::clock_t before = std::clock();
    const auto start = std::chrono::steady_clock::now();
    const auto is_late = [&] {
        return renderer_->has_endless_paths() &&
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > most_seconds;
    };
    if (!renderer_->render(first + spp, [&](double, double) { return !interrupted() && !is_late(); })) {
        if (interrupted())
            throw Interrupted{};
        throw Error(fmt::format("the strategy {}: paths do not end within {:g} s; give --max-depth or another --rr",
                                label_, most_seconds));
    }
    const double cpu_seconds = double(std::clock() - before) / CLOCKS_PER_SEC / cores_;
    RenderResult rendered{renderer_->film(), {}, clock_ == Clock::cpu ? cpu_seconds : renderer_->kernel_seconds()};
    rendered.image = image_of(rendered.film, false);
    return rendered;
}

namespace {

// The pilot's spp: its first number, the largest, and the largest factor from one try to the next.
constexpr unsigned first_spp = 8, max_spp = 1u << 16;
constexpr double max_growth = 8;

double median_of(std::vector<double> values) {
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return values.size() % 2 ? *middle : (*middle + *std::max_element(values.begin(), middle)) / 2;
}

} // namespace

Pilot run_pilot(CompiledStrategy &strategy, unsigned seed, double seconds) {
    unsigned spp = first_spp;
    const double most_seconds = std::fmax(10, 20 * seconds); // of paths that may be endless
    CompiledStrategy::RenderResult r = strategy.render(spp, seed, first_pilot_sample, most_seconds);
    while (r.seconds < seconds / 2 && spp < max_spp) {
        spp = unsigned(std::clamp(seconds / std::fmax(r.seconds, 1e-9) * spp, 2.0 * spp, max_growth * spp));
        r = strategy.render(spp, seed, first_pilot_sample, most_seconds);
    }
    Pilot pilot{spp, r.seconds / spp, {}, {}, strategy.uses_mis()};
    for (size_t p = 0; p < r.film.sum.size(); p++) {
        const double n = std::fmax(2, r.film.count[p]), sum = luminance(r.film.sum[p]);
        pilot.mean.push_back(sum / n);
        pilot.variance.push_back(std::fmax(0, r.film.squares[p][3] - sum * sum / n) / (n - 1));
    }
    return pilot;
}

std::vector<double> pilot_costs(const std::vector<Pilot> &pilots) {
    const size_t pixels = pilots[0].mean.size();
    std::vector<double> median(pixels);
    double floor = 0;
    for (size_t p = 0; p < pixels; p++) {
        std::vector<double> means;
        for (const Pilot &pilot : pilots)
            means.push_back(pilot.mean[p]);
        median[p] = median_of(means);
        floor += 0.01 * median[p] / double(pixels); // 1 % of the mean, as relMSE has it (image/metrics.h)
    }
    std::vector<double> variances;
    double least_mis = INFINITY;
    for (const Pilot &pilot : pilots) {
        double variance = 0, distance = 0;
        for (size_t p = 0; p < pixels; p++) {
            const double scale = median[p] * median[p] + floor * floor, d = pilot.mean[p] - median[p];
            variance += scale > 0 ? pilot.variance[p] / scale : 0;
            distance += scale > 0 ? pilot.spp * d * d / scale : 0;
        }
        variances.push_back(std::fmax(variance, distance) / double(pixels));
        if (pilot.mis)
            least_mis = std::fmin(least_mis, variance / double(pixels));
    }
    std::vector<double> costs;
    for (size_t i = 0; i < pilots.size(); i++) {
        const double least = pilots[i].mis || !std::isfinite(least_mis) ? 0 : least_mis - (1 - 0.5);
        costs.push_back(std::fmax(variances[i], least) * pilots[i].seconds_a_sample);
    }
    return costs;
}

} // namespace opal
