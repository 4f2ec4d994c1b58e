// When a render has enough: a time, or an error.
#pragma once

#include "render/renderer.h"

namespace opal {

struct StopRule {
    double seconds = 0;        // of kernel time; 0: no limit
    double relative_error = 0; // of the image's mean luminance, as its standard error; 0: no target
    bool given() const { return seconds > 0 || relative_error > 0; }
};

struct Stopped {
    unsigned spp = 0;         // samples a pixel that the film aims at
    unsigned pilot_spp = 0;   // rendered to decide on spp and then discarded
    double pilot_seconds = 0; // kernel time of those
    bool complete = true;     // false: `go_on` said stop
};

// Renders into an empty film until the rule is met or `most` samples a pixel are there. restart() has been called.
//
// time: stops at the first launch that ends past it; what stops it knows nothing of the samples' values.
//
// error: stopping when the estimated error has become small would prefer films that have not yet met their rare bright
// samples: biased. Instead a pilot grows until it holds a tenth of the samples that it finds necessary; then the film
// is emptied and filled with that many OTHER samples. Their number is independent of their values, so that mean and
// variance are unbiased (Stein, "A two-sample test for a linear hypothesis whose power is independent of the variance",
// 1945).
Stopped render_until(Renderer &renderer, const StopRule &rule, unsigned seed, unsigned most,
                     const Renderer::Continue &go_on);

// The samples a pixel at which statistics of a film with `spp` would reach this relative standard error; with a margin
// of 10 %, because the pilot's variance is itself an estimate.
double samples_for(const FilmStatistics &pilot, double spp, double relative_error);

} // namespace opal
