// The table of stress tests of `opal extremes`: each row stretches one parameter over many decades.
#pragma once

#include "extremes/numeric_rows.h"
#include "scene/scene.h"

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace opal::extremes {

// The meaning of a row's value: a parameter of its scene, or an option of the render.
enum class ValueMeaning { scene_parameter, spp, height, first_sample };

struct StressRow {
    std::string name;           // for --row
    std::string stretched;      // description of the parameter, with its unit
    std::vector<double> values; // in the order of the run
    double start;               // a harmless value; the working range is grown from it
    // The range of values in which single precision must agree with double; NaN: nothing is promised.
    double promised_from = std::numeric_limits<double>::quiet_NaN(), promised_to = promised_from;
    // Either a scene is rendered, or functions of the kernels are called.
    std::function<SceneDescription(double)> picture = {};
    NumericResult (*numeric)(double, const Device &, const StressSettings &) = nullptr;
    bool invariant = false;                   // all values should give the same picture
    std::function<double(double)> truth = {}; // mean luminance of the picture, where it is known
    // Scenes that count leaks and self-shadows, like closed_walls and open_plane; empty: not counted.
    std::function<SceneDescription(double)> closed = {}, open = {};
    double tolerance = 1e-4;                     // relative error of the energy that is allowed beyond noise
    std::optional<unsigned> side = {}, spp = {}; // override --side and --spp
    ValueMeaning value_means = ValueMeaning::scene_parameter; // spp: the picture has one pixel
};

const std::vector<StressRow> &stress_rows();

} // namespace opal::extremes
