// The reader of Mitsuba's scenes, of versions 0.x, 2.x and 3.x.
#pragma once

#include "read/load.h"

namespace opal::mitsuba {

// As opal::load_scene, of a file in Mitsuba's format. What a file does not say is as Mitsuba 3 has it, but for the
// strategy: scenes/README.md lists it.
SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options = {});

} // namespace opal::mitsuba
