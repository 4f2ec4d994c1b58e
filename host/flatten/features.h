// Decides what a scene's kernel is compiled with.
#pragma once

#include "flatten/flat_scene.h"

namespace opal {

constexpr int FACE_LIST_LANES = 4; // from this width on testing each of a few triangles beats a tree

// A feature's name (FEATURE_*), as `opal inspect` prints it.
const char *feature_name(unsigned feature);

// Everything in `scene` but its features must be there. With strategy.specialise off, all features are on and all axes
// -1.
Features find_features(const SceneDescription &description, const FlatScene &scene, int lanes);

// Of one kernel that renders every scene given (variants of one scene): a feature that any needs is on, and an axis on
// which they differ is decided at run time.
Features shared_features(const std::vector<FlatScene> &scenes);

} // namespace opal
