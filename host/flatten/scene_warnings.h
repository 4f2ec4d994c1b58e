// Warnings about a scene whose image is not what its author meant: nothing that the camera could see, lights that light
// nothing, faces that hide each other; and notes about what the file leaves out.
#pragma once

#include "scene/scene.h"

#include <cstdint>

namespace opal {

// One line "file:line:col: what" each. Each is certain: what it says holds for every strategy, and there is no claim
// where it would take rendering to know. Faces that coincide are looked for in scenes of at most `most_faces`
// triangles, as that takes 0.1 s and 8 MB a million.
std::vector<std::string> scene_warnings(const SceneDescription &scene, size_t most_faces = SIZE_MAX);

// Likewise, of what the file leaves to defaults. A number of samples that was given on the command line needs no note.
std::vector<std::string> scene_notes(const SceneDescription &scene, bool samples_given);

} // namespace opal
