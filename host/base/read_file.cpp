#include "base/read_file.h"

#include "base/descriptor.h"
#include "base/error.h"
#include "base/file_use.h"
#include "base/memory.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace opal {

namespace fs = std::filesystem;

namespace {

constexpr size_t most_of_unknown_size = size_t(1) << 30;

// A named descriptor is duplicated: opening it anew fails for a socket, and where the user may not open the file.
int open_to_read(const fs::path &file, std::optional<int> named, Pipes pipes) {
    // Without O_NONBLOCK a FIFO that nobody writes to is waited for.
    return again([&] {
        return named ? fcntl(*named, F_DUPFD_CLOEXEC, 0)
                     : open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | (pipes == Pipes::refused ? O_NONBLOCK : 0));
    });
}

// Why a file of this kind is not read; empty: it is.
std::string refusal(const struct stat &status, bool is_descriptor, Pipes pipes) {
    const std::string wanted = ", not a file";
    if (S_ISDIR(status.st_mode))
        return "is a folder" + wanted;
    if (S_ISBLK(status.st_mode) || (S_ISCHR(status.st_mode) && !(is_descriptor && pipes == Pipes::read)))
        return "is a device" + wanted;
    if (S_ISSOCK(status.st_mode) && !is_descriptor)
        return "is a socket" + wanted;
    if (!S_ISREG(status.st_mode) && pipes == Pipes::refused)
        return "is a pipe" + wanted;
    return "";
}

// at_begin: reads from the file's begin, and leaves the descriptor's offset, which it shares with its duplicates.
std::string read_all(const Descriptor &descriptor, const struct stat &status, bool at_begin, const fs::path &file) {
    const size_t size = S_ISREG(status.st_mode) ? size_t(status.st_size) : 0;
    check_memory(double(size), file.string() + ": cannot read");
    // One byte more than the size, so that the end is seen without growing. Files of /proc have the size 0.
    std::string bytes(size ? size + 1 : 65536, '\0');
    size_t count = 0;
    for (;;) {
        const size_t room = bytes.size() - count;
        const ssize_t more = again([&] {
            return at_begin ? pread(descriptor, bytes.data() + count, room, off_t(count))
                            : read(descriptor, bytes.data() + count, room);
        });
        if (more < 0)
            cannot_read(file, errno);
        if (more == 0)
            break;
        count += size_t(more);
        if (size == 0 && count > most_of_unknown_size)
            throw Error(fmt::format("{}: cannot read: more than 1 GiB comes from it; a file may be larger, a pipe not",
                                    file.string()));
        if (count == bytes.size())
            bytes.resize(2 * count);
    }
    if (count < size)
        throw Error(fmt::format("{}: cannot read: it ended after {} of {} bytes", file.string(), count, size));
    bytes.resize(count);
    return bytes;
}

// Throws where a file of this kind is not read.
void check_kind(const fs::path &file, const struct stat &status, std::optional<int> named, Pipes pipes) {
    const bool may_pass = named && (!S_ISCHR(status.st_mode) || isatty(*named));
    if (const std::string why = refusal(status, may_pass, pipes); !why.empty())
        throw Error(file.string() + ": " + why);
}

std::string read_new(const fs::path &file, Pipes pipes, bool &passes_by) {
    const std::optional<int> named = descriptor_of(file);
    struct stat status {};
    if ((named ? fstat(*named, &status) : stat(file.c_str(), &status)) != 0)
        cannot_read(file, errno);
    check_kind(file, status, named, pipes); // before it is opened, which does something to some devices
    note_input(file);
    const Descriptor descriptor(open_to_read(file, named, pipes));
    if (descriptor < 0 || fstat(descriptor, &status) != 0)
        cannot_read(file, errno);
    check_kind(file, status, named, pipes);
    const bool regular = S_ISREG(status.st_mode);
    passes_by = !regular;
    return read_all(descriptor, status, regular && named, file);
}

std::mutex mutex;
std::map<fs::path, std::string> passed_by; // what came through pipes

std::optional<std::string> kept(const fs::path &file) {
    const std::lock_guard lock(mutex);
    const auto found = passed_by.find(file);
    return found == passed_by.end() ? std::nullopt : std::optional(found->second);
}

void keep(const fs::path &file, const std::string &bytes) {
    const std::lock_guard lock(mutex);
    passed_by[file] = bytes;
}

} // namespace

std::string read_file(const fs::path &file, Pipes pipes) {
    try {
        if (pipes == Pipes::read)
            if (std::optional<std::string> bytes = kept(file))
                return *std::move(bytes);
        bool passes_by = false;
        std::string bytes = read_new(file, pipes, passes_by);
        if (passes_by)
            keep(file, bytes);
        return bytes;
    } catch (const std::bad_alloc &) {
        cannot_read(file, ENOMEM);
    } catch (const std::length_error &) { // more than a string can hold
        cannot_read(file, ENOMEM);
    }
}

void cannot_read(const fs::path &file, int error) {
    throw Error(file.string() + ": cannot read: " + std::strerror(error));
}

} // namespace opal
