// Which strategies make no sense for a scene.
#pragma once

#include "scene/scene.h"

namespace opal {

// Refuses, after all overrides, a strategy that makes no sense on this scene: Error with the reason. Warns of one that
// leaves light out or may not end.
void check_strategy(const SceneDescription &scene);

} // namespace opal
