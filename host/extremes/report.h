// What the sweeps found, as a table, as JSON and as a plot.
#pragma once

#include "extremes/measure.h"

#include <nlohmann/json_fwd.hpp>

namespace opal::extremes {

std::string table_of(const Sweep &sweep); // lines for the terminal
nlohmann::json json_of(const Sweep &sweep);
std::string svg_of(const std::vector<Sweep> &sweeps); // error against parameter, a panel a row

} // namespace opal::extremes
