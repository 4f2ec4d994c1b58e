// Pictures for textures: image files with their values as the file has them.
#pragma once

#include "base/hash.h"
#include "scene/textures.h"

#include <filesystem>
#include <map>
#include <memory>

namespace opal {

// Reads a PNG (8 and 16 bits, grey, colour, palette; alpha is dropped, gAMA ignored, as Mitsuba does both) or an EXR,
// told by its bytes. Throws Error that names the file: it is no such image, ends early, or is too large.
Picture read_picture(const std::filesystem::path &file, FileHashes *hashes = nullptr); // hashes: gets that of the bytes

// The pictures of a scene, each read once.
class Pictures {
public:
    std::shared_ptr<const Picture> at(const std::filesystem::path &file, FileHashes *hashes); // as read_picture

private:
    std::map<std::filesystem::path, std::shared_ptr<const Picture>> known_;
};

} // namespace opal
