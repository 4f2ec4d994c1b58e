// A folder of this process alone: drivers write there, and it holds the working directory while they run.
#pragma once

#include <filesystem>
#include <string>

namespace opal {

// Mode 700, in memory (/dev/shm), or, where that is small or runs no programs, in the cache folder or that for
// temporary files. It is removed when the process ends; the next process removes those of killed ones.
class WorkFolder {
public:
    static WorkFolder &own(); // of this process, made at the first call; Error if none can be made
    ~WorkFolder();
    WorkFolder(const WorkFolder &) = delete;
    WorkFolder &operator=(const WorkFolder &) = delete;

    std::filesystem::path driver_files() const { return path_ / "driver"; } // PoCL's, by the variable below
    std::filesystem::path empty() const { return path_ / "empty"; }

    // The file of the cache whose kernels are being launched for the first time. A process that finds a mark of one
    // that was killed removes the file, with a warning.
    void mark(const std::filesystem::path &file);
    void unmark();

private:
    WorkFolder();
    bool make_in(const std::filesystem::path &parent);
    std::filesystem::path mark_file() const; // of this process, which may be a fork of the owner
    std::filesystem::path path_;
    int lock_ = -1; // a locked file in it: the process lives
    pid_t owner_;
};

// PoCL asks it when its devices are listed first.
inline constexpr const char *pocl_cache_variable = "POCL_CACHE_DIR";

// While one lives, drivers may look up names in the working directory and print: the directory is the empty one above,
// as the user's may be a folder of a stranger, and stdout is stderr, as stdout is for results. Scopes may be nested, in
// the main thread alone. Relative names of files must not be used meanwhile.
class DriverScope {
public:
    DriverScope();
    ~DriverScope();
    DriverScope(const DriverScope &) = delete;
    DriverScope &operator=(const DriverScope &) = delete;
};

} // namespace opal
