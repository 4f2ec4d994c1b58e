// Reads whole files. A file that cannot be read to its end is an error, never a shorter text.
#pragma once

#include <filesystem>
#include <string>

namespace opal {

// All bytes of a file, pipe or device. Throws Error that names the file and the system's reason: it cannot be opened, a
// read fails, memory is short, or the file ends before its size.
std::string read_file(const std::filesystem::path &file);

// Throws the Error for an errno: "FILE: cannot read: Input/output error".
[[noreturn]] void cannot_read(const std::filesystem::path &file, int error);

} // namespace opal
