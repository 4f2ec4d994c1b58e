// Pictures for textures: image files with their values as the file has them.
#pragma once

#include "base/hash.h"
#include "scene/textures.h"

#include <filesystem>
#include <string>

namespace opal {

// An image file whose header is read: PNG (8 and 16 bits, grey, colour, palette; alpha is dropped, gAMA and profiles
// are ignored, as Mitsuba does), JPEG (grey or colour), Radiance HDR or OpenEXR, told by its bytes.
class PictureFile {
public:
    // Throws Error that names the file: it cannot be read, is no such image, is too large for the memory that is left,
    // or has fewer bytes than an image of its size. hashes: gets that of the bytes.
    explicit PictureFile(std::filesystem::path file, FileHashes *hashes = nullptr);

    const Picture &header() const { return header_; } // without values

    // The values. NaN and infinite ones are 0; `invalid` counts them. Throws Error: the file ends early, or is damaged.
    Picture decode(std::size_t &invalid) const;

private:
    std::filesystem::path file_;
    std::string bytes_;
    Picture header_;
};

// The picture of a file at once; warns of invalid values.
Picture read_picture(const std::filesystem::path &file, FileHashes *hashes = nullptr);

void warn_of_invalid(const std::filesystem::path &file, std::size_t invalid); // unless there are none

} // namespace opal
