#include "render/stop_rules.h"

#include "base/command_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal {

namespace {

constexpr unsigned first_pilot_spp = 16;
constexpr double pilot_share = 0.1, sample_margin = 1.1;
constexpr double black_image_spp = 65536; // after so many black samples of each pixel the image is taken to be black

bool out_of_time(const StopRule &rule, double kernel_seconds) {
    return (rule.seconds > 0 && kernel_seconds >= rule.seconds) ||
           (rule.wall_seconds > 0 && seconds_since_start() >= rule.wall_seconds);
}

} // namespace

double samples_for(const FilmStatistics &pilot, double spp, double relative_error) {
    if (!(pilot.mean_luminance > 0)) // no relative error exists
        return black_image_spp;
    const double relative = pilot.stderr_luminance / pilot.mean_luminance / relative_error;
    return std::max(2.0, std::ceil(sample_margin * spp * relative * relative)); // a variance needs 2
}

StopResult render_until(Renderer &renderer, const StopRule &rule, unsigned seed, unsigned max_spp,
                        const Renderer::OnLaunch &on_launch) {
    StopResult result{max_spp};
    if (rule.relative_error > 0) {
        double needed;
        do {
            result.pilot_spp = result.pilot_spp ? 2 * result.pilot_spp : first_pilot_spp;
            result.complete = renderer.render(result.pilot_spp, on_launch);
            needed = samples_for(statistics_of(renderer.film()), result.pilot_spp, rule.relative_error);
        } while (result.complete && result.pilot_spp < pilot_share * std::min(needed, double(max_spp)));
        result.pilot_seconds = renderer.kernel_seconds();
        if (!result.complete) // the film then keeps the pilot's samples
            return result;
        result.spp = unsigned(std::min(needed, double(max_spp)));
        renderer.restart(seed, result.pilot_spp);
    }
    bool in_time = true;
    const unsigned first = renderer.next_sample();
    const unsigned end = first + std::min(result.spp, std::numeric_limits<unsigned>::max() - first);
    result.complete = renderer.render(end, [&](double done, double seconds) {
        in_time = !out_of_time(rule, seconds);
        return in_time && (!on_launch || on_launch(done - first, seconds));
    }) || !in_time;
    return result;
}

} // namespace opal
