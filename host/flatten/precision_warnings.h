// What in a scene goes where single precision does not hold, or where light is made from nothing.
#pragma once

#include "flatten/flat_scene.h"

namespace opal {

// A line each, "file:line:col: what, and what follows". The limits are those that `opal extremes` found.
std::vector<std::string> sanity_warnings(const SceneDescription &scene, const FlatScene &flat);

} // namespace opal
