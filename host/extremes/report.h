// The results of stress tests as a table, as JSON and as a plot.
#pragma once

#include "extremes/measure.h"

#include <nlohmann/json_fwd.hpp>

namespace opal::extremes {

std::string table_of(const StressResult &result); // lines for the terminal
nlohmann::json json_of(const StressResult &result);
std::string svg_of(const std::vector<StressResult> &results); // error against parameter, one panel for each row

} // namespace opal::extremes
