#include "image/image.h"

#include "base/descriptor.h"
#include "base/error.h"
#include "base/file_use.h"
#include "base/log.h"
#include "base/signals.h"

#include <fmt/format.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <ctime>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include <dirent.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

namespace opal {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

namespace {

constexpr auto patience = 2s; // with a reader that takes nothing, after a signal

bool is_special(const struct stat &status) { return !S_ISREG(status.st_mode); }

[[noreturn]] void cannot_write(const fs::path &file, int error) {
    const std::string name = descriptor_of(file) == STDOUT_FILENO ? "stdout" : file.string();
    if (error == EINTR) // only a wait for a reader ends so
        throw InterruptedWait(name + ": not written: interrupted while it waited for a reader");
    throw Error(fmt::format("{}: cannot be written: {}", name, std::strerror(error)));
}

// Waits until a reader takes more. False: a signal has come, and the reader takes nothing.
bool wait_for_room(int descriptor) {
    pollfd poll{descriptor, POLLOUT, 0};
    for (auto end = std::chrono::steady_clock::now() + patience;;) {
        if (::poll(&poll, 1, 100) > 0) // room, or an error that the write tells
            return true;
        if (!interrupted())
            end = std::chrono::steady_clock::now() + patience;
        else if (std::chrono::steady_clock::now() > end)
            return false;
    }
}

// Returns errno, or 0. To what may have a slow reader, pieces are written for which poll promises room.
int write_and_sync(int descriptor, std::string_view bytes) {
    struct stat status {};
    const bool has_reader = fstat(descriptor, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISBLK(status.st_mode);
    const size_t most = has_reader ? PIPE_BUF : size_t(std::numeric_limits<ssize_t>::max());
    while (!bytes.empty()) {
        if (has_reader && !wait_for_room(descriptor))
            return EINTR;
        const ssize_t count = again([&] { return write(descriptor, bytes.data(), std::min(most, bytes.size())); });
        if (count < 0 && errno != EAGAIN)
            return errno;
        bytes.remove_prefix(count > 0 ? size_t(count) : 0);
    }
    // Some file systems report a full disk only here or at the close. A pipe cannot be synced.
    return again([&] { return fsync(descriptor); }) != 0 && errno != EINVAL && errno != ENOTSUP ? errno : 0;
}

int write_and_close(Descriptor descriptor, std::string_view bytes) {
    const int error = write_and_sync(descriptor, bytes);
    const int at_close = descriptor.close();
    return error ? error : at_close;
}

// Opens a FIFO when a reader has come. Returns -1 and EINTR after a signal.
int open_fifo(const fs::path &file) {
    for (bool told = false;; told = true) {
        const int descriptor = open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK);
        if (descriptor >= 0) {
            fcntl(descriptor, F_SETFL, O_WRONLY);
            return descriptor;
        }
        if (errno != ENXIO && errno != EINTR)
            return -1;
        if (interrupted()) {
            errno = EINTR;
            return -1;
        }
        if (!told)
            note(file.string() + ": waits for a reader");
        std::this_thread::sleep_for(20ms);
    }
}

// Writes into what is there: a device, a FIFO, or a file that cannot be replaced. Returns errno, or 0.
int write_in_place(const fs::path &target, const struct stat &status, std::string_view bytes) {
    const int flags = O_WRONLY | O_CLOEXEC | O_NOCTTY | (S_ISREG(status.st_mode) ? O_TRUNC : 0);
    Descriptor descriptor(S_ISFIFO(status.st_mode) ? open_fifo(target)
                                                   : again([&] { return open(target.c_str(), flags); }));
    return descriptor < 0 ? errno : write_and_close(std::move(descriptor), bytes);
}

// Through a descriptor that is open already: as its opener wanted it, say at the end of a log.
int write_through(int named, std::string_view bytes) {
    Descriptor descriptor(fcntl(named, F_DUPFD_CLOEXEC, 0));
    return descriptor < 0 ? errno : write_and_close(std::move(descriptor), bytes);
}

constexpr std::string_view temporary_start = ".opal-", temporary_end = ".tmp";
constexpr int temporary_digits = 16; // hexadecimal, of 64 bits
constexpr size_t temporary_size = temporary_start.size() + temporary_digits + temporary_end.size();

// No name of a target, which may be as long as a name can be; random, so that nobody can guess it, and that processes
// of one number in two containers do not meet.
std::string random_name() {
    uint64_t random = 0;
    if (getrandom(&random, sizeof random, 0) != sizeof random) // a kernel before 3.17; O_EXCL still holds
        random = uint64_t(std::chrono::steady_clock::now().time_since_epoch().count());
    return fmt::format("{}{:0{}x}{}", temporary_start, random, temporary_digits, temporary_end);
}

Descriptor open_folder_of(const fs::path &target) {
    const fs::path folder = folder_of(target);
    return Descriptor(again([&] { return open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC); }));
}

// A new file in a folder, removed unless it is renamed.
class TemporaryFile {
public:
    TemporaryFile(int folder, mode_t mode) : folder_(folder) {
        for (int tries = 0; tries < 100; tries++) {
            name_ = random_name();
            signal_.emplace(folder, name_);
            descriptor_.emplace(again([&] {
                return openat(folder, name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode);
            }));
            error_ = *descriptor_ < 0 ? errno : 0;
            there_ = error_ == 0;
            if (error_ != EEXIST)
                return;
        }
    }
    ~TemporaryFile() { remove(); }
    TemporaryFile(const TemporaryFile &) = delete;
    TemporaryFile &operator=(const TemporaryFile &) = delete;

    int error() const { return error_; } // of opening it
    int descriptor() const { return *descriptor_; }
    int write(std::string_view bytes) { return write_and_close(std::move(*descriptor_), bytes); }
    int rename_to(const std::string &name) {
        there_ = again([&] { return renameat(folder_, name_.c_str(), folder_, name.c_str()); }) != 0;
        return there_ ? errno : 0;
    }

    // Removes it unless it was renamed. Returns errno, or 0.
    int remove() {
        if (!there_)
            return 0;
        there_ = unlinkat(folder_, name_.c_str(), 0) != 0 && unlinkat(folder_, name_.c_str(), 0) != 0; // once more
        return there_ ? errno : 0;
    }

private:
    const int folder_;
    std::string name_;
    std::optional<RemovedBySignal> signal_;
    std::optional<Descriptor> descriptor_;
    int error_ = 0;
    bool there_ = false; // under its temporary name
};

// Gives a file the owner and the mode of the one that it replaces; the owner as far as the system allows it.
// Returns errno, or 0.
int take_over(int descriptor, const struct stat &old) {
    if (fchown(descriptor, old.st_uid, old.st_gid) != 0 && fchown(descriptor, uid_t(-1), old.st_gid) != 0) {
    }
    return again([&] { return fchmod(descriptor, old.st_mode & 0777); }) != 0 && errno != EPERM && errno != ENOTSUP
               ? errno
               : 0; // some file systems have no modes
}

// Returns errno, or 0. old: the file that is replaced; nullptr: there is none.
int replace(const fs::path &target, const struct stat *old, std::string_view bytes) {
    const Descriptor folder = open_folder_of(target);
    if (folder < 0)
        return errno;
    TemporaryFile temporary(folder, old ? old->st_mode & 0666 : 0666);
    if (temporary.error())
        return temporary.error();
    int error = old ? take_over(temporary.descriptor(), *old) : 0;
    if (error == 0)
        error = temporary.write(bytes);
    return error ? error : temporary.rename_to(target.filename().string());
}

// Removes what processes left that were killed (SIGKILL, a power cut) as they wrote: temporary files of this user that
// have not grown for a day.
void remove_leftovers(const fs::path &target) {
    constexpr time_t age = 24 * 3600;
    constexpr int most_entries = 10'000; // 3 ms
    const fs::path folder = folder_of(target);
    const std::unique_ptr<DIR, int (*)(DIR *)> listing(opendir(folder.c_str()), closedir);
    for (int i = 0; listing && i < most_entries; i++) {
        const dirent *const entry = readdir(listing.get());
        if (!entry)
            return;
        const std::string_view name = entry->d_name;
        struct stat status {};
        if (name.size() == temporary_size && name.starts_with(temporary_start) && name.ends_with(temporary_end) &&
            fstatat(dirfd(listing.get()), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISREG(status.st_mode) && status.st_uid == geteuid() && time(nullptr) - status.st_mtime > age)
            unlinkat(dirfd(listing.get()), entry->d_name, 0);
    }
}

void check_folder(const fs::path &file) {
    const fs::path folder = folder_of(file);
    std::error_code error;
    if (file.filename().empty() || fs::is_directory(file, error))
        throw Error(fmt::format("{}: is a folder, not a file to write", file.string()));
    if (!fs::exists(folder, error)) {
        if (error)
            throw Error(fmt::format("{}: cannot be written: {}", file.string(), error.message()));
        throw Error(fmt::format("{}: cannot be written: there is no folder {}", file.string(), folder.string()));
    }
    if (!fs::is_directory(folder, error))
        throw Error(fmt::format("{}: cannot be written: {} is not a folder", file.string(), folder.string()));
}

// What stands at a path. nullopt: nothing.
std::optional<struct stat> status_of(const fs::path &file, const fs::path &target) {
    struct stat status {};
    if (lstat(target.c_str(), &status) == 0)
        return status;
    if (errno != ENOENT)
        cannot_write(file, errno);
    return std::nullopt;
}

// Another user's file in a folder such as /tmp may be written, but not replaced.
bool is_kept_by_folder(const fs::path &target, const struct stat &status) {
    struct stat folder {};
    const uid_t user = geteuid();
    return stat(folder_of(target).c_str(), &folder) == 0 && (folder.st_mode & S_ISVTX) && user != 0 &&
           user != status.st_uid && user != folder.st_uid;
}

void check_replaceable(const fs::path &file, const fs::path &target, const struct stat &status) {
    if (access(target.c_str(), W_OK) != 0)
        cannot_write(file, errno);
    if (S_ISSOCK(status.st_mode) || S_ISBLK(status.st_mode))
        throw Error(fmt::format("{}: cannot be written: it is {}", file.string(),
                                S_ISSOCK(status.st_mode) ? "a socket" : "a disk"));
    if (is_special(status))
        return;
    if ((status.st_mode & 0222) == 0) // which root could write
        throw Error(
            fmt::format("{}: cannot be written: it is read-only (mode {:03o})", file.string(), status.st_mode & 0777));
    if (is_kept_by_folder(target, status))
        cannot_write(file, EPERM);
}

} // namespace

void make_folder(const fs::path &folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw Error(fmt::format("{}: no folder can be made there: {}", folder.string(), error.message()));
}

void check_writable(const fs::path &file) {
    if (const std::optional<int> named = descriptor_of(file)) {
        const int flags = fcntl(*named, F_GETFL);
        if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
            cannot_write(file, EBADF);
        return;
    }
    const fs::path target = target_of(file);
    check_folder(target);
    const std::optional<struct stat> status = status_of(file, target);
    if (status)
        check_replaceable(file, target, *status);
    if (status && is_special(*status))
        return;
    const Descriptor folder = open_folder_of(target);
    if (folder < 0)
        cannot_write(file, errno);
    TemporaryFile trial(folder, 0666);
    if (trial.error())
        cannot_write(file, trial.error());
    if (const int error = trial.remove()) // nor could it be renamed
        cannot_write(file, error);
    remove_leftovers(target);
}

void check_output(const fs::path &file) {
    check_writable(file);
    note_output(file);
}

void write_safely(const fs::path &file, const std::string &bytes) {
    int error = 0;
    if (const std::optional<int> named = descriptor_of(file)) {
        error = write_through(*named, bytes);
    } else {
        const fs::path target = target_of(file);
        check_folder(target);
        const std::optional<struct stat> status = status_of(file, target);
        const bool special = status && is_special(*status);
        if (!special)
            error = replace(target, status ? &*status : nullptr, bytes);
        if (error == ENOENT) // a temporary file of a process that slept for a day may have been removed
            error = replace(target, status ? &*status : nullptr, bytes);
        if (status && (special || error == EBUSY)) // a file that is a mount point, as containers have it
            error = write_in_place(target, *status, bytes);
    }
    if (error != 0)
        cannot_write(file, error);
}

} // namespace opal
