// The features of a scene: the decisions that its kernel is compiled with.
#pragma once

#include "flatten/flat_scene.h"

namespace opal {

constexpr int FACE_LIST_LANES = 4; // from this width on testing each of a few triangles beats a tree

// A feature's name (FEATURE_*), as `opal inspect` prints it.
const char *feature_name(unsigned feature);

// Finds the features of a flat scene that is otherwise complete. The general kernel has all features but those that
// cost most scenes more than they save a few, and all axes are -1, decided at run time.
Features find_features(const SceneDescription &description, const FlatScene &scene, int lanes);

// Has the scene nothing that a general kernel lacks until a scene asks for it: textures, skies that are images, most of
// the materials that Nori has not? Then the general kernel is the one that other scenes have compiled already.
bool shares_general_kernel(const SceneDescription &scene);

// The features of one kernel that renders all of these variants of a scene: a feature that any variant needs is on, and
// an axis on which variants differ is decided at run time.
Features shared_features(const std::vector<FlatScene> &scenes);

} // namespace opal
