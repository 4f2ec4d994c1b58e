// Warnings about a scene: values beyond the tested range of single precision, and materials that create energy.
#pragma once

#include "flatten/flat_scene.h"

namespace opal {

// One line "file:line:col: what, and what follows" for each warning. The limits are those that `opal extremes` found.
std::vector<std::string> precision_warnings(const SceneDescription &scene, const FlatScene &flat);

} // namespace opal
