// A library that tests preload into opal, so that a system call on files of a folder fails, or a signal comes there.
// $OPAL_FAULT_FOLDER: the folder, absolute. $OPAL_FAULT: WHAT@K for the K-th such call (from 1): EIO, ENOSPC
// and EINTR fail with that errno; of "short" a read or write takes half; before KILL, TERM and INT the signal comes.
// $OPAL_FAULT_LOG: a file that gets a line for each call, its name and its path.
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

template <class Function> Function next(const char *name, Function) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

std::atomic<long> calls = 0;

struct Fault {
    int error = 0, signal = 0;
    bool is_short = false;
    long at = 0;
};

Fault wanted() {
    Fault fault;
    const char *const given = std::getenv("OPAL_FAULT");
    const char *const at = given ? std::strchr(given, '@') : nullptr;
    if (!at)
        return fault;
    const std::string what(given, at);
    fault.at = std::atol(at + 1);
    fault.is_short = what == "short";
    fault.error = what == "EIO" ? EIO : what == "ENOSPC" ? ENOSPC : what == "EINTR" ? EINTR : 0;
    fault.signal = what == "KILL" ? SIGKILL : what == "TERM" ? SIGTERM : what == "INT" ? SIGINT : 0;
    return fault;
}

bool is_watched(const char *path) {
    static const char *const folder = std::getenv("OPAL_FAULT_FOLDER");
    return folder && path && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

// The path of a descriptor; that of its folder and the name where a name is given.
std::string path_of(int descriptor, const char *name = nullptr) {
    if (name && name[0] == '/')
        return name;
    char link[64], path[4096] = "";
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t size = descriptor == AT_FDCWD ? (getcwd(path, sizeof path) ? ssize_t(std::strlen(path)) : 0)
                                                : syscall(SYS_readlink, link, path, sizeof path);
    return std::string(path, size > 0 ? size_t(size) : 0) + (name ? std::string("/") + name : "");
}

// Counts a call. Returns what shall happen to it; a signal has come already.
Fault meet(const char *call, const std::string &path) {
    static const Fault fault = wanted();
    static const char *const log = std::getenv("OPAL_FAULT_LOG");
    if (!is_watched(path.c_str()))
        return {};
    const long number = ++calls;
    if (log) {
        const std::string line = std::string(call) + " " + path + "\n";
        const long file = syscall(SYS_openat, AT_FDCWD, log, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
        syscall(SYS_write, file, line.data(), line.size());
        syscall(SYS_close, file);
    }
    if (number != fault.at)
        return {};
    if (fault.signal)
        kill(getpid(), fault.signal);
    return fault;
}

int opened(const char *name, int folder, const char *path, int flags, mode_t mode) {
    static const auto real = next("openat", openat);
    if (const Fault fault = meet(name, path_of(folder, path)); fault.error) {
        errno = fault.error;
        return -1;
    }
    return real(folder, path, flags, mode);
}

mode_t mode_in(int flags, va_list arguments) {
    return flags & (O_CREAT | O_TMPFILE) ? mode_t(va_arg(arguments, unsigned)) : 0;
}

} // namespace

#define OPAL_MEET(name, path)                                                                                          \
    const Fault fault = meet(name, path);                                                                              \
    if (fault.error) {                                                                                                 \
        errno = fault.error;                                                                                           \
        return -1;                                                                                                     \
    }

extern "C" {

int open(const char *path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = mode_in(flags, arguments);
    va_end(arguments);
    return opened("open", AT_FDCWD, path, flags, mode);
}

int open64(const char *path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = mode_in(flags, arguments);
    va_end(arguments);
    return opened("open", AT_FDCWD, path, flags, mode);
}

int openat(int folder, const char *path, int flags, ...) {
    va_list arguments;
    va_start(arguments, flags);
    const mode_t mode = mode_in(flags, arguments);
    va_end(arguments);
    return opened("openat", folder, path, flags, mode);
}

ssize_t read(int descriptor, void *bytes, size_t size) {
    static const auto real = next("read", read);
    OPAL_MEET("read", path_of(descriptor))
    return real(descriptor, bytes, fault.is_short && size > 1 ? size / 2 : size);
}

ssize_t write(int descriptor, const void *bytes, size_t size) {
    static const auto real = next("write", write);
    OPAL_MEET("write", path_of(descriptor))
    return real(descriptor, bytes, fault.is_short && size > 1 ? size / 2 : size);
}

int fsync(int descriptor) {
    static const auto real = next("fsync", fsync);
    OPAL_MEET("fsync", path_of(descriptor))
    return real(descriptor);
}

// The descriptor is closed in any case, as by Linux.
int close(int descriptor) {
    static const auto real = next("close", close);
    const Fault fault = meet("close", path_of(descriptor));
    const int result = real(descriptor);
    if (!fault.error)
        return result;
    errno = fault.error;
    return -1;
}

int renameat(int folder, const char *from, int to_folder, const char *to) {
    static const auto real = next("renameat", renameat);
    OPAL_MEET("renameat", path_of(to_folder, to))
    return real(folder, from, to_folder, to);
}

int unlinkat(int folder, const char *path, int flags) {
    static const auto real = next("unlinkat", unlinkat);
    OPAL_MEET("unlinkat", path_of(folder, path))
    return real(folder, path, flags);
}

int fchmod(int descriptor, mode_t mode) {
    static const auto real = next("fchmod", fchmod);
    OPAL_MEET("fchmod", path_of(descriptor))
    return real(descriptor, mode);
}

int mkdir(const char *path, mode_t mode) {
    static const auto real = next("mkdir", mkdir);
    OPAL_MEET("mkdir", path_of(AT_FDCWD, path))
    return real(path, mode);
}

} // extern "C"
