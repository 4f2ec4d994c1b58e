// Kinds of files, told by their bytes: a file of another kind under a scene's or a mesh's name is named in the error,
// with the way to convert it.
#pragma once

#include "base/hash.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace opal {

enum class FileKind {
    unknown,
    obj,           // statements of a Wavefront OBJ
    ply,           // begins with the line "ply"
    mtl,           // statements of a Wavefront material library
    scene,         // XML whose root is <scene> or <test>
    mitsuba_scene, // XML of Mitsuba: <scene version="3.0.0"> with its tags
    png,
    jpeg,
    hdr, // Radiance
    exr,
    picture, // wanted: any of the four above
    text,    // any other text that Opal does not read
    other,   // anything else that Opal does not read
};

struct FileKindRow {
    FileKind kind = FileKind::unknown;
    std::string name; // with its article: "a binary PLY mesh"; empty if unknown
    std::string
        advice; // how to get what Opal reads, FILE and NEW stand for names: "unpack it: unzip FILE"; may be empty
};

// The kind of a file by its first bytes, and for text by its root element or first statement.
FileKindRow kind_of(std::string_view bytes);

// The error about a file that is no `wanted`: "FILE: is a PLY mesh, not an OBJ file; convert it: ...".
std::string wrong_kind_text(const std::filesystem::path &file, const FileKindRow &found, FileKind wanted);

// All text of a file without its UTF-8 byte order mark. Throws Error: the file cannot be read; it is of another kind
// than `wanted`; it is UTF-16 or UTF-32; a line ends with a carriage return alone. hashes: gets that of the bytes.
std::string read_text_file(const std::filesystem::path &file, FileKind wanted, FileHashes *hashes = nullptr);

} // namespace opal
