#include "render/render_film.h"

#include "base/command_line.h"
#include "base/progress.h"
#include "base/signals.h"
#include "flatten/flat_scene.h"

#include <algorithm>
#include <optional>

namespace opal {

RenderedFilm render_film(const Device &device, FlatScene scene, const RenderOptions &options, const StopRule &rule,
                         unsigned seed, unsigned spp) {
    constexpr unsigned most_samples = 1u << 31;
    const double pixels = double(scene.settings.film.width) * scene.settings.film.height;
    Renderer renderer(device, std::move(scene), options);
    renderer.restart(seed);
    watch_interrupts();
    const unsigned most = spp ? spp : most_samples;
    const double start = seconds_since_start();
    RenderedFilm rendered;
    {
        std::optional<Progress> progress; // none where nobody knows yet how much there is to do
        if (rule.seconds > 0)
            progress.emplace("render", rule.seconds, "s");
        else if (rule.wall_seconds > 0)
            progress.emplace("render", std::max(rule.wall_seconds - seconds_since_start(), 0.1), "s");
        else if (!rule.given())
            progress.emplace("render", most * pixels);
        rendered.stopped = render_until(renderer, rule, seed, most, [&](double samples, double kernel_seconds) {
            if (progress)
                progress->update(rule.seconds > 0        ? kernel_seconds
                                 : rule.wall_seconds > 0 ? seconds_since_start() - start
                                                         : samples * pixels);
            return !interrupted();
        });
    }
    rendered.film = renderer.take_film();
    rendered.compile_seconds = renderer.compile_seconds();
    rendered.kernel_seconds = renderer.kernel_seconds();
    return rendered;
}

} // namespace opal
