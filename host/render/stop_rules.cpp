#include "render/stop_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal {

namespace {

constexpr unsigned first_pilot = 16;
constexpr double pilot_share = 0.1, margin = 1.1;
constexpr double black_samples = 65536; // a pixel, after which a black image is taken for black

} // namespace

double samples_for(const FilmStatistics &pilot, double spp, double relative_error) {
    if (!(pilot.mean_luminance > 0)) // black so far: no error relative to it
        return black_samples;
    const double relative = pilot.stderr_luminance / pilot.mean_luminance / relative_error;
    return std::max(2.0, std::ceil(margin * spp * relative * relative)); // 2: so that there is a variance to state
}

Stopped render_until(Renderer &renderer, const StopRule &rule, unsigned seed, unsigned most,
                     const Renderer::Continue &go_on) {
    Stopped stopped{most};
    if (rule.relative_error > 0) {
        double needed;
        do {
            stopped.pilot_spp = stopped.pilot_spp ? 2 * stopped.pilot_spp : first_pilot;
            stopped.complete = renderer.render(stopped.pilot_spp, go_on);
            needed = samples_for(statistics_of(renderer.film()), stopped.pilot_spp, rule.relative_error);
        } while (stopped.complete && stopped.pilot_spp < pilot_share * std::min(needed, double(most)));
        stopped.pilot_seconds = renderer.kernel_seconds();
        if (!stopped.complete) // interrupted: the pilot's samples are better than nothing
            return stopped;
        stopped.spp = unsigned(std::min(needed, double(most)));
        renderer.restart(seed, stopped.pilot_spp);
    }
    bool in_time = true;
    const unsigned first = renderer.next_sample();
    const unsigned end = first + std::min(stopped.spp, std::numeric_limits<unsigned>::max() - first);
    stopped.complete = renderer.render(end, [&](double done, double seconds) {
        in_time = rule.seconds <= 0 || seconds < rule.seconds;
        return in_time && (!go_on || go_on(done - first, seconds));
    }) || !in_time;
    return stopped;
}

} // namespace opal
