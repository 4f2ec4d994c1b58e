// The page of a sweep: one HTML file that needs neither the network nor other files.
#pragma once

#include "sweep/analysis.h"

namespace opal {

// folder: the sweep's folder, whose PNGs are embedded.
std::string html_page(const SweepRecord &record, const SweepSummary &summary, const std::filesystem::path &folder);

// The verdict as sentences of plain text; the first names the best strategy.
std::vector<std::string> verdict(const SweepRecord &record, const SweepSummary &summary);

} // namespace opal
