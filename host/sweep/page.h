// The page of a sweep: one HTML file that needs neither the network nor other files.
#pragma once

#include "sweep/analysis.h"

namespace opal {

// folder: the sweep's folder, whose PNGs are embedded.
std::string html_page(const SweepRecord &record, const SweepSummary &summary, const std::filesystem::path &folder);

// The verdict as sentences of plain text; the first names the best strategy.
std::vector<std::string> verdict(const SweepRecord &record, const SweepSummary &summary);

// The sweep of a scene with one value of a $name.
struct ValueSweep {
    std::string value, folder; // folder: of its own page, below that of the table
    SweepSummary summary;
};

// Do the replicates tell that a strategy is slower than the best one?
bool is_slower(const StrategySummary &strategy);
// Tables of the seconds to relMSE ranking_level, of each strategy at each value of `name`.
std::string text_table(const std::string &name, const std::vector<ValueSweep> &sweeps);
std::string html_table_page(const std::string &scene, const std::string &name, const std::vector<ValueSweep> &sweeps);

} // namespace opal
