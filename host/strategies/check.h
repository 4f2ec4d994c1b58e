// The check of a strategy against its scene.
#pragma once

#include "scene/scene.h"

namespace opal {

// Error with the reason if the scene's strategy makes no sense on it. Warns if the strategy misses light or may not
// end. Call it after all overrides.
void check_strategy(const SceneDescription &scene);

} // namespace opal
