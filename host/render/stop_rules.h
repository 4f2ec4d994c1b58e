// Stop rules: render until a time has passed or a relative error is reached.
#pragma once

#include "render/renderer.h"

namespace opal {

struct StopRule {
    double seconds = 0;        // limit of kernel time; 0: none
    double wall_seconds = 0;   // limit of the time since the start of the process, by the wall clock; 0: none
    double relative_error = 0; // target: standard error of the image's mean luminance over that mean; 0: none
    bool given() const { return seconds > 0 || wall_seconds > 0 || relative_error > 0; }
};

struct StopResult {
    unsigned spp = 0;         // samples of each pixel that were to be rendered
    unsigned pilot_spp = 0;   // samples of the pilot, which chose spp and was then discarded
    double pilot_seconds = 0; // kernel time of the pilot
    bool complete = true;     // false: on_launch stopped the render
};

// Renders until the rule is met or each pixel has `max_spp` samples. The film must be empty: call restart(seed) before.
//
// A limit of time stops at the first launch that ends after it. The decision does not depend on the samples' values.
//
// An error target is met in two stages (Stein 1945, "A two-sample test for a linear hypothesis whose power is
// independent of the variance"). A pilot grows until it holds a tenth of the samples that it finds necessary. Then the
// film is emptied and filled with that many other samples. Their number does not depend on their values, so that mean
// and variance are unbiased. To stop as soon as the estimated error is small would be biased: it prefers films that
// have not yet met their rare bright samples.
StopResult render_until(Renderer &renderer, const StopRule &rule, unsigned seed, unsigned max_spp,
                        const Renderer::OnLaunch &on_launch);

// The samples of each pixel that a film needs for this relative standard error, by a pilot of `spp` samples. The result
// includes a margin of 10 %, because the pilot's variance is itself an estimate.
double samples_for(const FilmStatistics &pilot, double spp, double relative_error);

} // namespace opal
