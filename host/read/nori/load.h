// The reader of Nori's scenes, in the dialects of Nori itself and of the 2022 course.
#pragma once

#include "scene/scene.h"

namespace opal {

struct LoadOptions {
    bool lenient = false; // an unknown property warns instead of failing
};

// Reads a scene. Relative file names are looked for beside the XML file, then in the current folder. Throws Error
// "file:line:col: what is wrong; available: ...".
SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options = {});

} // namespace opal
