// The reader of Nori's scenes, in the dialects of Nori itself, of the 2022 course and of ETH's course.
#pragma once

#include "read/load.h"

namespace opal {

// As load_scene, of a file in Nori's format.
SceneDescription load_nori_scene(const std::filesystem::path &file, const LoadOptions &options = {});

} // namespace opal
