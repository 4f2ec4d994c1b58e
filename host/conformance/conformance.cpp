#include "conformance/conformance.h"

#include "densities/sampled.h"
#include "render/kernel_choice.h"
#include "render/renderer.h"
#include "scene/options.h"
#include "strategies/check.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

namespace opal {

namespace {

Vec3 direction_at(double degrees) {
    const double theta = degrees * std::numbers::pi / 180;
    return {std::sin(theta), 0, std::cos(theta)};
}

class TestRun {
public:
    TestRun(const TestDescription &test, const Device &device, const ConformanceOptions &options,
            const std::function<void(const ConformanceCase &)> &on_case)
        : test_(test), device_(device), options_(options), on_case_(on_case) {}

    std::vector<ConformanceCase> run() {
        level_ = stats::sidak_level(test_.significance_level, double(count_cases(test_)));
        for (const SceneDescription &scene : test_.scenes)
            mean_of_scene(scene);
        if (!test_.bsdfs.empty())
            run_bsdfs();
        return std::move(done_);
    }

private:
    void finish(ConformanceCase result) {
        result.passed = !result.result.rejected(level_);
        if (on_case_)
            on_case_(result);
        done_.push_back(std::move(result));
    }

    void judge_mean(const std::string &name, const stats::Sample &sample, const std::string &problem) {
        ConformanceCase result;
        result.name = name;
        result.reference = test_.references.at(done_.size());
        result.mean = sample.mean;
        result.standard_error = std::sqrt(sample.variance / sample.n);
        result.samples = sample.n;
        result.result = stats::t_test(sample, result.reference);
        if (!problem.empty())
            result.result = {NAN, 0, 0, problem};
        finish(result);
    }

    // Mean luminance of camera rays over the whole image; the pixels are strata.
    void mean_of_scene(SceneDescription scene) {
        override_strategy(scene.strategy, options_.overrides);
        check_strategy(scene);
        scene.camera.filter = {};
        const size_t pixels = size_t(scene.camera.width) * size_t(scene.camera.height);
        scene.spp = unsigned(std::max<size_t>(2, (size_t(test_.sample_count) + pixels - 1) / pixels));
        scene.strategy.few_paths = suits_general_kernel(device_.info, double(pixels) * scene.spp, scene);

        RenderOptions render;
        render.build = options_.build;
        render.sources = options_.sources;
        Renderer renderer(device_, flatten(scene, render.build.lanes), render);
        renderer.restart(options_.seed);
        renderer.render(scene.spp);
        const FilmStatistics film = statistics_of(renderer.film());
        const double n = double(film.samples);
        judge_mean(integrator_name(scene), {n, film.mean_luminance, film.stderr_luminance * film.stderr_luminance * n},
                   film.invalid ? fmt::format("{} samples are NaN or infinite", film.invalid) : "");
    }

    void run_bsdfs() {
        KernelProbe probe(device_, scene_of_bsdfs(test_.bsdfs), options_.build, *options_.sources);
        std::mt19937 random(options_.seed);
        for (unsigned id = 0; id < test_.bsdfs.size(); id++)
            if (test_.type == "ttest")
                for (double angle : test_.angles)
                    albedo(probe, id, angle);
            else
                for (int i = 0; i < test_.test_count; i++)
                    histogram(probe, id, random);
    }

    // Mean luminance of sample weights: the directional albedo.
    void albedo(KernelProbe &probe, unsigned id, double angle) {
        stats::Moments weights;
        draw_in_batches(probe, size_t(test_.sample_count), options_.seed + unsigned(done_.size()),
                        [&](const Planes &numbers) {
                            // Nori's weights are those of radiance.
                            const Planes drawn = of_radiance(probe.bsdf_sample(id, direction_at(angle), numbers));
                            for (size_t i = 0; i < drawn.count; i++) {
                                const Vec3 w = drawn.vec3(BSDF_WEIGHT_R, i);
                                weights.add(luminance({w.x, w.y, w.z}));
                            }
                        });
        judge_mean(fmt::format("{} at {:g} degrees", bsdf_name(test_.bsdfs[id].kind()), angle), weights.sample(), "");
    }

    // Chi-square of directions, for a wi drawn in proportion to its cosine.
    void histogram(KernelProbe &probe, unsigned id, std::mt19937 &random) {
        std::uniform_real_distribution<double> unit;
        const double sine = std::sqrt(unit(random)), phi = 2 * std::numbers::pi * unit(random);
        const Vec3 wi = {sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1 - sine * sine)};
        const int nu = test_.resolution, nv = 2 * test_.resolution;
        ConformanceCase result;
        result.is_mean = false;
        result.name = fmt::format("{} at {:.2f} degrees", bsdf_name(test_.bsdfs[id].kind()),
                                  std::asin(sine) * 180 / std::numbers::pi);
        result.samples = test_.sample_count > 0 ? test_.sample_count : 5000.0 * nu * nv;
        stats::ChiSquareOptions options;
        options.min_expected = test_.min_expected_frequency;
        result.result = check_density(probe, sampled_bsdf(probe, id, wi), nu, nv, size_t(result.samples),
                                      options_.seed + unsigned(done_.size()), options)
                            .test.result;
        finish(result);
    }

    const TestDescription &test_;
    const Device &device_;
    const ConformanceOptions &options_;
    const std::function<void(const ConformanceCase &)> &on_case_;
    double level_ = 0;
    std::vector<ConformanceCase> done_;
};

} // namespace

size_t count_cases(const TestDescription &test) {
    return test.type == "chi2test" ? test.bsdfs.size() * size_t(test.test_count) : test.references.size();
}

std::vector<ConformanceCase> run_test(const TestDescription &test, const Device &device,
                                      const ConformanceOptions &options,
                                      const std::function<void(const ConformanceCase &)> &on_case) {
    return TestRun(test, device, options, on_case).run();
}

} // namespace opal
