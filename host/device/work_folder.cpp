#include "device/work_folder.h"

#include "base/error.h"
#include "base/log.h"
#include "base/read_file.h"
#include "device/kernel_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace opal {

namespace {

namespace fs = std::filesystem;

constexpr const char *prefix = "opal-run-", *lock_name = "lock", *mark_name = "first_launch";
constexpr unsigned long long least_room = 32ull << 20; // bytes; a render's kernels take less than 2 MB
constexpr time_t longest_start = 60;                   // seconds from making the folder to locking it

// Whether compiled kernels can be written there and loaded.
bool has_room(const fs::path &folder) {
    struct statvfs status {};
    return statvfs(folder.c_str(), &status) == 0 && !(status.f_flag & (ST_RDONLY | ST_NOEXEC)) &&
           1ull * status.f_bavail * status.f_frsize >= least_room;
}

// A process that left a mark died in the first launch of the kernels of the file that it names. It may have had another
// cache.
void distrust_marked(const fs::path &mark) {
    fs::path file;
    try {
        file = read_file(mark);
    } catch (const Error &) { // it is gone
        return;
    }
    if (file.is_absolute() && file.parent_path() == cache_folder().path && unlink(file.c_str()) == 0)
        warn(fmt::format("{}: a run ended while it launched these kernels for the first time: they are thrown away and "
                         "compiled anew",
                         file.string()));
}

// Forked processes share the work folder, and each has a mark of its own.
void distrust_all_marked(const fs::path &folder) {
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (at->path().filename().string().starts_with(mark_name))
            distrust_marked(at->path());
}

// Removes the work folders of processes that were killed.
void remove_dead(const fs::path &parent) {
    std::error_code error, ignored;
    for (fs::directory_iterator at(parent, error), end; !error && at != end; at.increment(error)) {
        const fs::path folder = at->path();
        struct stat status {};
        if (!folder.filename().string().starts_with(prefix) || lstat(folder.c_str(), &status) != 0 ||
            !S_ISDIR(status.st_mode) || status.st_uid != geteuid())
            continue;
        const int lock = open((folder / lock_name).c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC);
        const bool has_none = lock < 0 && errno == ENOENT; // its process may be about to make it
        const bool dead = has_none ? status.st_mtime < time(nullptr) - longest_start
                                   : lock >= 0 && flock(lock, LOCK_EX | LOCK_NB) == 0;
        if (dead) {
            distrust_all_marked(folder);
            fs::remove_all(folder, ignored);
        }
        if (lock >= 0)
            close(lock);
    }
}

} // namespace

WorkFolder &WorkFolder::own() {
    static WorkFolder folder;
    return folder;
}

WorkFolder::WorkFolder() : owner_(getpid()) {
    const CacheFolder &cache = cache_folder();
    if (!cache.problem.empty())
        note(fmt::format("compiled kernels are not kept for the next run: {}", cache.problem));
    std::error_code ignored;
    // In memory first: to make and remove files on a disk takes milliseconds.
    std::vector<std::string> parents = {"/dev/shm", fs::absolute(fs::temp_directory_path(ignored), ignored)};
    if (cache.problem.empty()) {
        parents.insert(parents.begin() + 1, cache.path);
        remove_dead(cache.path);
    }
    std::erase(parents, ""); // there is no such temporary folder
    const bool made = std::ranges::any_of(parents, [&](const fs::path &p) { return has_room(p) && make_in(p); }) ||
                      std::ranges::any_of(parents, [&](const fs::path &p) { return make_in(p); });
    if (!made)
        throw Error(fmt::format("drivers need a folder for compiled kernels, and none can be made in {}: {}",
                                fmt::join(parents, ", "), std::strerror(errno)));
}

bool WorkFolder::make_in(const fs::path &parent) {
    remove_dead(parent);
    for (;;) {
        std::string name = (parent / (std::string(prefix) + "XXXXXX")).string();
        if (!mkdtemp(name.data()))
            return false;
        path_ = name;
        chmod(name.c_str(), S_IRWXU); // whatever the umask
        lock_ = open((path_ / lock_name).c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
        struct stat status {};
        const bool locked = lock_ >= 0 && flock(lock_, LOCK_EX) == 0;
        if (locked && fstat(lock_, &status) == 0 && status.st_nlink == 0) {
            close(lock_); // remove_dead of another process came between
            continue;
        }
        const auto make = [](const fs::path &folder) {
            return mkdir(folder.c_str(), S_IRWXU) == 0 && chmod(folder.c_str(), S_IRWXU) == 0;
        };
        if (locked && make(driver_files()) && make(empty()))
            return true;
        const int problem = errno;
        std::error_code ignored;
        fs::remove_all(path_, ignored);
        if (lock_ >= 0)
            close(std::exchange(lock_, -1));
        path_.clear();
        errno = problem;
        return false;
    }
}

WorkFolder::~WorkFolder() {
    std::error_code ignored;
    if (getpid() != owner_ || path_.empty())
        return;
    distrust_all_marked(path_); // of forked processes that died
    fs::remove_all(path_, ignored);
}

fs::path WorkFolder::mark_file() const { return path_ / fmt::format("{}-{}", mark_name, getpid()); }

void WorkFolder::mark(const fs::path &file) { std::ofstream(mark_file()) << file.string(); }

void WorkFolder::unmark() { unlink(mark_file().c_str()); }

namespace {

int open_scopes = 0;
int directory_before = -1;
int results = -1; // stdout, while descriptor 1 is stderr

} // namespace

DriverScope::DriverScope() {
    const fs::path empty = WorkFolder::own().empty();
    if (open_scopes) {
        open_scopes++;
        return;
    }
    directory_before = open("/proc/self/cwd", O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (directory_before < 0)
        directory_before = open(".", O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (directory_before < 0)
        throw Error(fmt::format("the working directory cannot be opened: {}", std::strerror(errno)));
    if (chdir(empty.c_str()) != 0 && chdir("/") != 0) { // someone removed the empty one
        const int problem = errno;
        close(directory_before);
        throw Error(fmt::format("{}: cannot be entered: {}", empty.string(), std::strerror(problem)));
    }
    if (results < 0)
        results = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    dup2(STDERR_FILENO, STDOUT_FILENO);
    open_scopes++;
}

DriverScope::~DriverScope() {
    if (--open_scopes)
        return;
    std::fflush(stdout); // what the driver has printed: Opal's own text is never kept back
    if (results >= 0)
        dup2(results, STDOUT_FILENO);
    (void)!fchdir(directory_before); // also if the folder was removed meanwhile
    close(directory_before);
}

} // namespace opal
