// One HTML file that tells what a sweep found: no network, no other file.
#pragma once

#include "sweep/analysis.h"

namespace opal {

// folder: where the shots' PNGs lie; they are embedded.
std::string html_page(const SweepRecord &record, const SweepSummary &summary, const std::filesystem::path &folder);

// The verdict's sentences, the best strategy's first; plain text.
std::vector<std::string> verdict(const SweepRecord &record, const SweepSummary &summary);

} // namespace opal
