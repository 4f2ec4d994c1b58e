// Reads a Nori scene (both dialects, shared/SCENE_FORMAT) into a SceneDescription.
#pragma once

#include "scene/scene.h"

#include <map>

namespace opal {

struct LoadOptions {
    bool lenient = false; // an unknown property warns instead of failing
};

// Throws Error "file:line:col: what is wrong; available: ...". Relative file names are looked for beside the XML file,
// then in the current folder.
SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options = {});

// Command-line overrides by axis name ("lighting" -> "mis") and number name ("max-depth", "rr-prob", "rr-depth").
// Throws Error where a name or value does not exist.
void override_strategy(Strategy &strategy, const std::map<std::string, std::string> &overrides);

// Refuses combinations that make no sense, with the reason (after overrides): Error.
void check_strategy(const SceneDescription &scene);

} // namespace opal
