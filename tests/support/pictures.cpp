#include "support/pictures.h"

#include "read/nori/load.h"
#include "scene/options.h"
#include "strategies/check.h"
#include "support/device.h"

namespace opal::test {

SceneDescription with(SceneDescription scene, const Overrides &overrides) {
    override_strategy(scene.strategy, overrides);
    if (const auto named = overrides.find("integrator"); named != overrides.end())
        scene.integrator_type = named->second;
    check_strategy(scene);
    return scene;
}

Renderer renderer_of(const SceneDescription &scene, const Shot &shot) {
    RenderOptions options;
    options.build.lanes = lanes_for(device().info, shot.lanes, shot.math);
    options.build.math = shot.math;
    options.sources = shot.sources;
    options.max_pass_samples = shot.max_pass_samples;
    return Renderer(device(), flatten(scene, options.build.lanes), options);
}

Film render(const SceneDescription &scene, unsigned spp, unsigned seed, const Shot &shot) {
    Renderer renderer = renderer_of(scene, shot);
    renderer.restart(seed);
    renderer.render(spp);
    return renderer.film();
}

stats::Sample sample_of(const Film &film, int channel) {
    const std::array<double, 3> weights = channel == 3   ? std::array<double, 3>{0.212671, 0.715160, 0.072169}
                                          : channel == 0 ? std::array<double, 3>{1, 0, 0}
                                          : channel == 1 ? std::array<double, 3>{0, 1, 0}
                                                         : std::array<double, 3>{0, 0, 1};
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
