// Scenes rendered by the Renderer itself, for tests that judge pictures.
#pragma once

#include "render/renderer.h"
#include "scene/scene.h"
#include "stats/moments.h"

#include <map>
#include <string>

namespace opal::test {

// How a picture is rendered. Nothing of it may change the expectation.
struct RenderSetup {
    int lanes = 0; // 0: the device's own
    const Sources *sources = &Sources::embedded();
    unsigned max_pass_samples = 0;
    double launch_seconds = RenderOptions().launch_seconds;
    MathMode math = MathMode::precise;
};

using Overrides = std::map<std::string, std::string>; // {"lighting", "mis"}

// The scene under another strategy, checked as the command line checks it.
SceneDescription with_strategy(SceneDescription scene, const Overrides &overrides);

Renderer renderer_of(const SceneDescription &scene, const RenderSetup &setup = {});
Film render(const SceneDescription &scene, unsigned spp, unsigned seed, const RenderSetup &setup = {});

// The image's mean of a channel (0 R, 1 G, 2 B) or of the luminance (3) as a sample of `samples` observations, with the
// variance of the image's noise: each pixel is a stratum. For z_test and welch_test.
stats::Sample sample_of(const Film &film, int channel = 3);

} // namespace opal::test
