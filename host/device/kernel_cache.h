// The cache of compiled kernels: a folder with one file a program. The file holds what the driver (PoCL) writes for the
// program into a folder of its own, so that it need not compile it again. The driver gets a file's contents only where
// size and hash are right. Processes may share the folder: files are renamed into place.
#pragma once

#include <ctime>
#include <filesystem>
#include <map>
#include <set>
#include <string>

namespace opal {

struct CacheFolder {
    std::filesystem::path path; // empty: there is none to read from
    std::string problem;        // why nothing can be written there; else empty
};

// $POCL_CACHE_DIR, else $XDG_CACHE_HOME/opal, else $HOME/.cache/opal. It is made, with mode 700, where it is missing. A
// folder is not used if it is a link, belongs to another user, or others may write to it.
const CacheFolder &cache_folder();

struct CacheContents {
    size_t programs = 0;
    unsigned long long bytes = 0;
};
CacheContents cache_contents(const std::filesystem::path &folder);
inline constexpr const char *silent_extension = ".silent"; // of a file that says that a driver did not answer
void clear_cache(const std::filesystem::path &folder);

// Removes the files that were not used for longest until the others take at most so many bytes, and what a process
// left that was killed while it wrote.
void trim_cache(const std::filesystem::path &folder, unsigned long long most_bytes);
inline constexpr unsigned long long most_cache_bytes = 200ull << 20;

// Warns that nothing can be kept there; once a process.
void warn_not_kept(const std::filesystem::path &file, int error);

// A program's file in the cache.
class CachedProgram {
public:
    // identity: all that the compiled kernels depend on. driver_files: the folder that the driver keeps kernels in.
    // Copies the kernels there if the cache has them. A damaged file is removed, with a warning. Then the program is to
    // be built.
    CachedProgram(const std::string &identity, std::filesystem::path driver_files);

    void find_files(); // call when it was built: finds the driver's files of this program
    void store();      // writes the file anew if the driver has made more of them
    void remove();
    std::filesystem::path path() const { return cache_folder().path / name_; }
    bool was_cached() const { return cached_; }

    // Whether this process has not launched that kernel yet, and it comes from the cache. Next time: false.
    bool is_first_launch(const std::string &kernel) { return cached_ && launched_.insert(kernel).second; }

private:
    using Sizes = std::map<std::string, std::uintmax_t>; // of files, by their path below driver_files_
    void unpack(const std::string &bytes);
    Sizes driver_sizes() const;

    std::string name_;
    std::filesystem::path driver_files_;
    std::filesystem::path place_; // the program's folder below driver_files_; empty: the driver keeps none
    bool cached_ = false;
    Sizes stored_;
    timespec folder_changed_{}; // when driver_files_ was changed last, as store saw it
    std::set<std::string> launched_;
};

} // namespace opal
