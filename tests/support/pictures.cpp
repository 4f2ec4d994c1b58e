#include "support/pictures.h"

#include "read/nori/load.h"
#include "scene/options.h"
#include "strategies/check.h"
#include "support/device.h"

namespace opal::test {

SceneDescription with_strategy(SceneDescription scene, const Overrides &overrides) {
    override_strategy(scene.strategy, overrides);
    if (const auto named = overrides.find("integrator"); named != overrides.end())
        scene.integrator_type = named->second;
    check_strategy(scene);
    return scene;
}

Renderer renderer_of(const SceneDescription &scene, const RenderSetup &setup) {
    RenderOptions options;
    options.build.lanes = lanes_for(device().info, setup.lanes, setup.math);
    options.build.math = setup.math;
    options.sources = setup.sources;
    options.max_pass_samples = setup.max_pass_samples;
    options.launch_seconds = setup.launch_seconds;
    return Renderer(device(), flatten(scene, options.build.lanes), options);
}

Film render(const SceneDescription &scene, unsigned spp, unsigned seed, const RenderSetup &setup) {
    Renderer renderer = renderer_of(scene, setup);
    renderer.restart(seed);
    renderer.render(spp);
    return renderer.film();
}

stats::Sample sample_of(const Film &film, int channel) {
    Color weights = luminance_weights;
    if (channel < 3) {
        weights = {0, 0, 0};
        weights[size_t(channel)] = 1;
    }
    double samples = 0, mean = 0, variance = 0; // variance of the mean
    const double pixels = double(film.sum.size());
    for (size_t p = 0; p < film.sum.size(); p++) {
        const double n = film.count[p];
        const double sum = film.sum[p][0] * weights[0] + film.sum[p][1] * weights[1] + film.sum[p][2] * weights[2];
        samples += n;
        mean += sum / n / pixels;
        variance += std::max(0.0, film.squares[p][channel] - sum * sum / n) / (n * (n - 1)) / (pixels * pixels);
    }
    return {samples, mean, variance * samples};
}

} // namespace opal::test
