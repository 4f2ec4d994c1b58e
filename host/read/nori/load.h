// The reader of Nori's scenes, in the dialects of Nori itself, of the 2022 course and of ETH's course.
#pragma once

#include "scene/scene.h"

#include <map>
#include <string>

namespace opal {

struct LoadOptions {
    bool lenient = false;                             // what is unknown warns instead of failing
    std::string dialect = "auto";                     // the name of a Dialect; auto: by the names in the scene
    std::map<std::string, std::string> definitions{}; // values of $name in attributes (XmlDocument::define)
};

// Reads a scene. Relative file names are looked for beside the XML file, then in the current folder. Throws Error
// "file:line:col: what is wrong; available: ...", or an ErrorList of all mistakes.
SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options = {});

} // namespace opal
