// The table of what `opal extremes` stretches: one row a parameter.
#pragma once

#include "scene/scene.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace opal::extremes {

struct Row {
    std::string name;              // as --row takes it
    std::string stretched;         // what, with its unit
    std::vector<double> values;    // in the order of the sweep
    double start;                  // where arithmetic is easy: the working range is told from here
    double promised_from = std::numeric_limits<double>::quiet_NaN(); // single precision must agree with double in between;
    double promised_to = promised_from;                              // NaN: nothing is promised
    std::function<SceneDescription(double)> picture;
    bool invariant = false;                                          // the picture should be the same for every value
    std::function<double(double)> truth = {};                        // its mean, where that is known
    std::function<SceneDescription(double)> closed = {}, open = {};  // as closed_walls and open_plane; empty: not asked
    std::optional<int> side = {}, spp = {};                          // instead of --side, --spp
    bool value_is_spp = false;                                       // then the picture has one pixel
};

const std::vector<Row> &rows();

} // namespace opal::extremes
