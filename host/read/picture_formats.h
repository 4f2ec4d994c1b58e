// The formats of pictures. Each tells by the header what a file holds, then decodes its values; both throw
// std::runtime_error with the reason why the bytes are no such image.
#pragma once

#include "scene/textures.h"

#include <filesystem>
#include <string_view>

namespace opal {

struct PictureHeader {
    Picture picture;     // without its values
    double file_bytes;   // that a file of so many pixels has at the least
    double memory_bytes; // that its values and decoding them take
};

PictureHeader png_header(const std::filesystem::path &file, std::string_view bytes);
void decode_png(std::string_view bytes, Picture &picture);

PictureHeader jpeg_header(const std::filesystem::path &file, std::string_view bytes);
void decode_jpeg(std::string_view bytes, Picture &picture);

PictureHeader hdr_header(const std::filesystem::path &file, std::string_view bytes);
void decode_hdr(std::string_view bytes, Picture &picture);

} // namespace opal
