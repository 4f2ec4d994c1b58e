#include "image/image.h"

#include "base/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace opal {

namespace fs = std::filesystem;

namespace {

// The file itself, with symbolic links followed.
fs::path target_of(const fs::path &file) {
    std::error_code ignored;
    const fs::path target = fs::is_symlink(file, ignored) ? fs::weakly_canonical(file, ignored) : file;
    return target.empty() ? file : target;
}

bool is_special(const fs::path &file) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    return fs::exists(status) && !fs::is_regular_file(status);
}

fs::path temporary_beside(const fs::path &file) {
    return file.parent_path() / fmt::format(".{}.{}.tmp", file.filename().string(), getpid());
}

[[noreturn]] void cannot_write(const fs::path &file, int error) {
    throw Error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(error)));
}

// Returns errno, or 0. Some file systems report a full disk only at fsync or close.
int write_all(int descriptor, const std::string &bytes) {
    for (size_t done = 0; done < bytes.size();) {
        const ssize_t count = write(descriptor, bytes.data() + done, bytes.size() - done);
        if (count < 0 && errno != EINTR)
            return errno;
        done += count > 0 ? static_cast<size_t>(count) : 0;
    }
    return fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP ? errno : 0; // a pipe cannot be synced
}

int write_and_close(int descriptor, const std::string &bytes) {
    const int error = write_all(descriptor, bytes);
    return close(descriptor) != 0 && error == 0 ? errno : error;
}

int open_new(const fs::path &temporary) {
    return open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
}

void check_folder(const fs::path &file) {
    const fs::path folder = file.parent_path().empty() ? fs::path(".") : file.parent_path();
    if (file.filename().empty() || fs::is_directory(file))
        throw Error(fmt::format("{}: is a folder, not a file to write", file.string()));
    if (!fs::exists(folder))
        throw Error(fmt::format("{}: cannot be written: there is no folder {}", file.string(), folder.string()));
    if (!fs::is_directory(folder))
        throw Error(fmt::format("{}: cannot be written: {} is not a folder", file.string(), folder.string()));
}

} // namespace

void make_folder(const fs::path &folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error)
        throw Error(fmt::format("{}: no folder can be made there: {}", folder.string(), error.message()));
}

void check_writable(const fs::path &file) {
    const fs::path target = target_of(file);
    check_folder(target);
    if (is_special(target)) {
        if (access(target.c_str(), W_OK) != 0)
            cannot_write(file, errno);
        return;
    }
    const fs::path temporary = temporary_beside(target);
    const int descriptor = open_new(temporary);
    if (descriptor < 0)
        cannot_write(file, errno);
    close(descriptor);
    unlink(temporary.c_str());
}

void write_safely(const fs::path &file, const std::string &bytes) {
    const fs::path target = target_of(file);
    check_folder(target);
    const bool special = is_special(target);
    const fs::path written = special ? target : temporary_beside(target);
    const int descriptor = special ? open(target.c_str(), O_WRONLY | O_CLOEXEC) : open_new(written);
    if (descriptor < 0)
        cannot_write(file, errno);
    int error = write_and_close(descriptor, bytes);
    if (!special && error == 0 && rename(written.c_str(), target.c_str()) != 0)
        error = errno;
    if (error != 0) {
        if (!special)
            unlink(written.c_str());
        cannot_write(file, error);
    }
}

} // namespace opal
