// The convergence plot as SVG text.
#pragma once

#include "sweep/analysis.h"

namespace opal {

std::string strategy_color(size_t index); // CSS colour of the summary's strategy `index`

// relMSE against seconds on logarithmic axes: one line for each strategy, one point with its interval for each spp.
std::string convergence_plot(const SweepSummary &summary);

} // namespace opal
