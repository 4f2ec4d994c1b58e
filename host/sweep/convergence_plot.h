// The convergence plot as SVG text.
#pragma once

#include "sweep/analysis.h"

namespace opal {

std::string strategy_color(size_t place);        // of the summary's strategies, as CSS
std::string html_text(const std::string &plain); // with &, <, > and quotes escaped

// relMSE against seconds, both logarithmic; a line a strategy, a point with its interval for each spp.
std::string convergence_plot(const SweepSummary &summary);
std::string svg_file(std::string svg); // such a text as a file of its own

} // namespace opal
