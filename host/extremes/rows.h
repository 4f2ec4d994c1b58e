// The table of what `opal extremes` stretches: one row a parameter.
#pragma once

#include "extremes/numeric_rows.h"
#include "scene/scene.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace opal::extremes {

enum class Value { of_scene, spp, height, first_sample }; // what a row's value is beside a parameter of its scene

struct Row {
    std::string name;           // as --row takes it
    std::string stretched;      // what, with its unit
    std::vector<double> values; // in the order of the sweep
    double start;               // where arithmetic is easy: the working range is told from here
    double promised_from =
        std::numeric_limits<double>::quiet_NaN();         // single precision must agree with double in between;
    double promised_to = promised_from;                   // NaN: nothing is promised
    std::function<SceneDescription(double)> picture = {}; // or
    Probed (*probe)(double, const Device &, const How &) = nullptr;
    bool invariant = false;                                         // the picture should be the same for every value
    std::function<double(double)> truth = {};                       // its mean, where that is known
    std::function<SceneDescription(double)> closed = {}, open = {}; // as closed_walls and open_plane; empty: not asked
    double tolerance = 1e-4;                                        // of the energy, where that is more than the noise
    std::optional<unsigned> side = {}, spp = {};                    // instead of --side, --spp
    Value value_is = Value::of_scene;                               // spp: of one pixel
};

const std::vector<Row> &rows();

} // namespace opal::extremes
