// Reads a Nori scene (both dialects, shared/SCENE_FORMAT) into a SceneDescription.
#pragma once

#include "scene/scene.h"

namespace opal {

struct LoadOptions {
    bool lenient = false; // an unknown property warns instead of failing
};

// Throws Error "file:line:col: what is wrong; available: ...". Relative file names are looked for beside the XML file,
// then in the current folder.
SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options = {});

} // namespace opal
