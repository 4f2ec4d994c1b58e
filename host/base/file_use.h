// What a path names, and what this process does with the file: no file is both read and written, and none is written
// for two purposes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace opal {

// The folder of a file by its path; "." where the path is a name alone.
std::filesystem::path folder_of(const std::filesystem::path &file);

// The file itself: symbolic links are followed, a dangling one to the file that would be made. A link that names a
// descriptor (/dev/stdout) stays. Throws Error for a loop of links.
std::filesystem::path target_of(const std::filesystem::path &file);

// The descriptor that a path names: /dev/stdout, /dev/fd/3, /proc/self/fd/3, or a link to one.
std::optional<int> descriptor_of(const std::filesystem::path &file);

// Whether both name one file or FIFO, by other paths or hard links, too. Devices and sockets are never one.
bool is_same_file(const std::filesystem::path &a, const std::filesystem::path &b);

// Notes a file that is read, or that will be written. Throws UsageError where a file would be both, or would be written
// twice. All files must be noted before the work begins.
void note_input(const std::filesystem::path &file);
void note_output(const std::filesystem::path &file);

// The same for files that a command writes into a folder of its own: throws UsageError if a file whose name begins so
// lies there and was read before, by whatever name.
void check_own_files(const std::filesystem::path &folder, const std::vector<std::string> &beginnings);

} // namespace opal
