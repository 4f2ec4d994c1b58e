// Environments from image files.
#pragma once

#include "base/hash.h"
#include "scene/environment.h"
#include "scene/place.h"

#include <filesystem>

namespace opal {

// Reads a picture as the radiance of an environment. Throws Error that names the file. hashes: gets that of the bytes.
std::shared_ptr<const EnvironmentMap> read_environment(const std::filesystem::path &file, FileHashes *hashes);

// A warning at the place of the transform if it changes lengths or angles: the environment is turned and mirrored
// alone.
void warn_of_scale(const Transform &to_world, const SourcePlace &place);

} // namespace opal
