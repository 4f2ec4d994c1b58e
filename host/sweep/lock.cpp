#include "sweep/lock.h"

#include "base/error.h"
#include "base/log.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace opal {

namespace {

// " (process 4711)", as the holder of the lock wrote it; empty if it is unknown.
std::string holder(int file) {
    char text[32] = {};
    const ssize_t count = pread(file, text, sizeof text - 1, 0);
    const long process = count > 0 ? std::strtol(text, nullptr, 10) : 0;
    return process > 0 ? fmt::format(" (process {})", process) : "";
}

} // namespace

FolderLock::FolderLock(const std::filesystem::path &folder) {
    const std::filesystem::path path = folder / ".sweep.lock";
    file_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0)
        throw Error(fmt::format("{}: cannot write: {}", path.string(), std::strerror(errno)));
    if (flock(file_, LOCK_EX | LOCK_NB) == 0) {
        const std::string process = fmt::format("{}\n", getpid());
        if (ftruncate(file_, 0) != 0 || pwrite(file_, process.data(), process.size(), 0) < 0)
            note(path.string() + ": cannot write: " + std::strerror(errno)); // the lock holds without it
        return;
    }
    const int error = errno;
    const std::string other = error == EWOULDBLOCK ? holder(file_) : "";
    close(file_);
    file_ = -1;
    if (error == EWOULDBLOCK)
        throw Error(fmt::format("{}: another sweep{} writes there; wait for it, or give another folder with -o",
                                folder.string(), other));
    warn(fmt::format("{}: cannot be locked ({}): no other sweep may write there now", folder.string(),
                     std::strerror(error)));
}

FolderLock::~FolderLock() {
    if (file_ >= 0)
        close(file_); // a child that was forked keeps the lock as long as it lives
}

} // namespace opal
