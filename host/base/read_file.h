// Reads whole files. A file that cannot be read to its end is an error, never a shorter text.
#pragma once

#include <filesystem>
#include <string>

namespace opal {

enum class Pipes {
    read,   // "/dev/stdin", <(command): what a user names
    refused // what another file names, as a mesh: it could be read but once, and might never come
};

// All bytes of a file, or of a pipe, which is kept for later calls. Throws Error that names the file and the system's
// reason: it cannot be opened, a read fails, memory is short, or the file ends before its size; it is a folder, a
// device or a socket (but for a terminal that is stdin), or a pipe of more than 1 GiB. Notes the file as an input
// (base/file_use.h).
std::string read_file(const std::filesystem::path &file, Pipes pipes = Pipes::read);

// Throws the Error for an errno: "FILE: cannot read: Input/output error".
[[noreturn]] void cannot_read(const std::filesystem::path &file, int error);

} // namespace opal
