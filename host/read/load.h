// A scene from a file of any format that Opal reads: Nori's, or Mitsuba's.
#pragma once

#include "scene/scene.h"

#include <map>
#include <string>

namespace opal {

struct LoadOptions {
    bool lenient = false;                             // what is unknown warns instead of failing
    std::string dialect = "auto";                     // the name of a Dialect; auto: by what the file says
    std::map<std::string, std::string> definitions{}; // values of $name in attributes
    std::string sensor{}; // of several cameras the one with this id, or of this number, from 0; empty: the first
};

// Reads a scene. A root with a `version` is Mitsuba's, if its tags are not Nori's. Relative file names are looked for
// beside the XML file, then in the current folder. Throws Error "file:line:col: what is wrong; available: ...", or an
// ErrorList of all mistakes.
SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options = {});

} // namespace opal
