// A render from start to end: the stage between a flat scene and the report of its film.
#pragma once

#include "render/stop_rules.h"

namespace opal {

struct RenderedFilm {
    Film film;
    StopResult stopped;
    double compile_seconds = 0, kernel_seconds = 0; // the latter of the film's samples
};

// Compiles and renders until the rule is met, `spp` samples a pixel are there, or Ctrl-C stops it (see
// base/signals.h). Shows a bar of the progress where the end is known. spp 0: the rule alone decides.
RenderedFilm render_film(const Device &device, FlatScene scene, const RenderOptions &options, const StopRule &rule,
                         unsigned seed, unsigned spp);

} // namespace opal
