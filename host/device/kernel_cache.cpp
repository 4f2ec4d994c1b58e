#include "device/kernel_cache.h"

#include "base/descriptor.h"
#include "base/environment.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/read_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace opal {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view file_extension = ".kernels", magic = "opal kernels 1\n", temporary_prefix = ".opal-tmp-";
constexpr const char *last_access = "last_accessed"; // PoCL writes such a file at each build of the program beside it

// Makes the folder, with those above it, and checks whose it is.
CacheFolder checked_folder(const fs::path &folder) {
    std::error_code ignored;
    fs::create_directories(folder.parent_path(), ignored);
    const auto failed = [&](const fs::path &path, const std::string &why) {
        return CacheFolder{path, fmt::format("{}: {}", folder.string(), why)};
    };
    if (mkdir(folder.c_str(), S_IRWXU) != 0 && errno != EEXIST)
        return failed({}, std::strerror(errno));
    const Descriptor open_folder(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    struct stat status {};
    if (open_folder < 0 || fstat(open_folder, &status) != 0)
        return failed({}, fs::is_symlink(folder, ignored) ? "it is a link" : std::strerror(errno));
    if (status.st_uid != geteuid())
        return failed({}, fmt::format("it belongs to the user {}", status.st_uid));
    if (status.st_mode & (S_IWGRP | S_IWOTH))
        return failed({}, fmt::format("others may write to it (chmod go-w {})", folder.string()));
    if (faccessat(open_folder, ".", W_OK | X_OK, AT_EACCESS) != 0)
        return failed(folder, std::strerror(errno));
    return {folder, {}};
}

CacheFolder find_cache_folder() {
    if (const std::string chosen = variable("POCL_CACHE_DIR"); !chosen.empty()) {
        std::error_code ignored; // the user chose it, so it may be a link
        fs::path folder = fs::weakly_canonical(fs::absolute(chosen), ignored);
        return checked_folder(folder.has_filename() ? folder : folder.parent_path());
    }
    if (const fs::path folder = variable("XDG_CACHE_HOME"); folder.is_absolute()) // others count as not set
        return checked_folder(folder / "opal");
    const fs::path home = variable("HOME");
    std::error_code ignored;
    if (!home.is_absolute())
        return {{}, "HOME is not set"};
    if (!fs::is_directory(home, ignored))
        return {{}, fmt::format("HOME, {}, is no folder", home.string())};
    return checked_folder(home / ".cache" / "opal");
}

template <class Visit> void visit_files(const fs::path &folder, Visit visit) {
    std::error_code error; // files may go meanwhile
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        struct stat status {};
        if (lstat(at->path().c_str(), &status) == 0 && S_ISREG(status.st_mode))
            visit(at->path(), status);
    }
}

bool is_temporary(const fs::path &file) { return file.filename().string().starts_with(temporary_prefix); }

std::string read_all(int descriptor, size_t size) {
    std::string bytes(size, '\0');
    for (size_t done = 0; done < size;) {
        const ssize_t count = again([&] { return read(descriptor, bytes.data() + done, size - done); });
        if (count <= 0)
            throw Error(count == 0 ? "it is cut short" : std::strerror(errno));
        done += size_t(count);
    }
    return bytes;
}

// Removes and returns the text up to `end`, and `end`. Throws Error if there is none.
std::string_view cut(std::string_view &text, char end) {
    const size_t length = text.find(end);
    if (length == text.npos)
        throw Error("it is cut short");
    const std::string_view word = text.substr(0, length);
    text.remove_prefix(length + 1);
    return word;
}

// The part of a cache file behind its hash. Throws Error, saying what is wrong, unless it is whole and that program's.
std::string_view checked_contents(std::string_view bytes, const std::string &name) {
    if (!bytes.starts_with(magic))
        throw Error("it does not begin as it should");
    bytes.remove_prefix(magic.size());
    const std::string_view hash = cut(bytes, '\n');
    if (hash != xxh128(bytes))
        throw Error("its hash is another than when it was written");
    if (cut(bytes, '\n') != name)
        throw Error("it is another program's");
    return bytes;
}

} // namespace

const CacheFolder &cache_folder() {
    static const CacheFolder folder = find_cache_folder();
    return folder;
}

void warn_not_kept(const fs::path &file, int error) {
    static bool warned = false;
    if (!std::exchange(warned, true))
        warn(
            fmt::format("compiled kernels are not kept for the next run: {}: {}", file.string(), std::strerror(error)));
}

CacheContents cache_contents(const fs::path &folder) {
    CacheContents contents;
    visit_files(folder, [&](const fs::path &file, const struct stat &status) {
        if (file.extension() == file_extension) {
            contents.programs++;
            contents.bytes += (unsigned long long)status.st_size;
        }
    });
    return contents;
}

void clear_cache(const fs::path &folder) {
    visit_files(folder, [&](const fs::path &file, const struct stat &) {
        const fs::path extension = file.extension();
        if ((extension == file_extension || extension == silent_extension || is_temporary(file)) &&
            unlink(file.c_str()) != 0 && errno != ENOENT)
            throw Error(fmt::format("{}: cannot be removed: {}", file.string(), std::strerror(errno)));
    });
}

void trim_cache(const fs::path &folder, unsigned long long most_bytes) {
    struct File {
        timespec used;
        fs::path path;
        unsigned long long bytes;
    };
    const time_t hour_ago = time(nullptr) - 3600;
    std::vector<File> files;
    unsigned long long bytes = 0;
    visit_files(folder, [&](const fs::path &file, const struct stat &status) {
        if (file.extension() == file_extension) {
            files.push_back({status.st_mtim, file, (unsigned long long)status.st_size});
            bytes += files.back().bytes;
        } else if (status.st_mtim.tv_sec < hour_ago && (file.extension() == silent_extension || is_temporary(file)))
            unlink(file.c_str());
    });
    std::ranges::sort(files, [](const File &a, const File &b) {
        return std::pair(a.used.tv_sec, a.used.tv_nsec) < std::pair(b.used.tv_sec, b.used.tv_nsec);
    });
    for (size_t i = 0; bytes > most_bytes && i < files.size(); i++)
        if (unlink(files[i].path.c_str()) == 0)
            bytes -= files[i].bytes;
}

CachedProgram::CachedProgram(const std::string &identity, fs::path driver_files)
    : name_(xxh128(identity) + std::string(file_extension)), driver_files_(std::move(driver_files)) {
    std::error_code ignored;
    for (const auto &[file, size] : driver_sizes()) // so that find_files knows the one that is built next
        if (fs::path(file).filename() == last_access)
            fs::remove(driver_files_ / file, ignored);
    if (cache_folder().path.empty())
        return;
    const fs::path file = path();
    const Descriptor opened(open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (opened < 0 && errno == ENOENT)
        return;
    try {
        struct stat status {};
        if (opened < 0)
            throw Error(std::strerror(errno));
        if (fstat(opened, &status) != 0 || !S_ISREG(status.st_mode) || status.st_uid != geteuid())
            throw Error("it is no file of this user");
        if ((unsigned long long)status.st_size > most_cache_bytes)
            throw Error("it is too large");
        unpack(read_all(opened, size_t(status.st_size)));
        futimens(opened, nullptr); // trim_cache removes those first that are not used
    } catch (const Error &error) {
        warn(fmt::format("{}: a damaged file of the cache of kernels ({}): it is thrown away, and its kernels are "
                         "compiled anew",
                         file.string(), error.what()));
        remove();
    }
}

void CachedProgram::remove() { unlink(path().c_str()); }

void CachedProgram::unpack(const std::string &bytes) {
    std::string_view left = checked_contents(bytes, name_);
    while (!left.empty()) {
        const std::string_view size_text = cut(left, ' ');
        const std::string path(cut(left, '\n'));
        size_t size = 0;
        const auto parsed = std::from_chars(size_text.data(), size_text.data() + size_text.size(), size);
        if (parsed.ec != std::errc() || size > left.size() || path.find("..") != path.npos || path.starts_with('/'))
            throw Error("it lists a file that it cannot hold");
        const fs::path file = driver_files_ / path;
        std::error_code ignored;
        fs::create_directories(file.parent_path(), ignored);
        const Descriptor made(open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRWXU));
        if (made < 0 && errno != EEXIST) // this process has made it before
            return;
        if (made >= 0 && write_all(made, left.substr(0, size))) {
            unlink(file.c_str());
            return;
        }
        stored_[path] = size;
        left.remove_prefix(size);
    }
    cached_ = true;
}

CachedProgram::Sizes CachedProgram::driver_sizes() const {
    Sizes sizes;
    std::error_code error, of_file;
    for (fs::recursive_directory_iterator at(driver_files_ / place_, error), end; !error && at != end;
         at.increment(error))
        if (at->is_regular_file(of_file))
            sizes[at->path().lexically_relative(driver_files_).string()] = at->file_size(of_file);
    return sizes;
}

void CachedProgram::find_files() {
    place_.clear();
    for (const auto &[file, size] : driver_sizes())
        if (fs::path(file).filename() == last_access)
            place_ = fs::path(file).parent_path();
}

void CachedProgram::store() {
    if (cache_folder().path.empty() || !cache_folder().problem.empty() || place_.empty())
        return;
    // PoCL makes files in its folder when it compiles, which takes longer than the clocks of file systems count by.
    struct stat status {};
    if (stat(driver_files_.c_str(), &status) != 0 ||
        (status.st_mtim.tv_sec == folder_changed_.tv_sec && status.st_mtim.tv_nsec == folder_changed_.tv_nsec))
        return;
    folder_changed_ = status.st_mtim;
    Sizes sizes = driver_sizes();
    std::erase_if(sizes, [](const auto &file) { return fs::path(file.first).filename() == last_access; });
    if (sizes == stored_)
        return;
    std::string contents = name_ + '\n';
    for (const auto &[file, size] : sizes) {
        const std::string bytes = read_file(driver_files_ / file);
        contents += fmt::format("{} {}\n", bytes.size(), file) + bytes;
    }
    const fs::path folder = cache_folder().path, file = path();
    std::string temporary = (folder / (std::string(temporary_prefix) + "XXXXXX")).string();
    const int made = mkostemp(temporary.data(), O_CLOEXEC); // exclusive, mode 600
    if (made < 0)
        return warn_not_kept(file, errno);
    int error = write_all(made, std::string(magic) + xxh128(contents) + '\n' + contents);
    if (close(made) != 0 && !error)
        error = errno;
    if (!error && rename(temporary.c_str(), file.c_str()) != 0)
        error = errno;
    if (error) {
        unlink(temporary.c_str());
        return warn_not_kept(file, error);
    }
    stored_ = std::move(sizes);
    trim_cache(folder, most_cache_bytes);
}

} // namespace opal
