#include "base/file_use.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <mutex>
#include <set>
#include <string>

#include <sys/stat.h>

namespace opal {

namespace fs = std::filesystem;

namespace {

std::mutex mutex; // of both sets; meshes may be read by several threads
std::set<fs::path> inputs, outputs;

fs::path descriptor_folder() {
    std::error_code ignored;
    static const fs::path folder = fs::canonical("/proc/self/fd", ignored);
    return folder;
}

// The path with the links of its folder followed; as it is where there is no such folder.
fs::path in_true_folder(const fs::path &file) {
    std::error_code error;
    const fs::path folder = fs::canonical(folder_of(file), error);
    return error ? file : folder / file.filename();
}

[[noreturn]] void refuse(const fs::path &file, const fs::path &other, const char *what) {
    const std::string also = fs::absolute(file) == other ? "" : fmt::format(" (also named {})", other.string());
    throw UsageError(fmt::format("{}{}: {}", file.string(), also, what));
}

constexpr const char *read_and_written = "would be both read and written; name another file to write";

} // namespace

fs::path folder_of(const fs::path &file) { return file.parent_path().empty() ? "." : file.parent_path(); }

fs::path target_of(const fs::path &file) {
    constexpr int most_links = 40; // as Linux has it
    fs::path target = file;
    for (int links = 0; links < most_links; links++) {
        std::error_code error;
        if (!fs::is_symlink(target, error))
            return target;
        const fs::path named = in_true_folder(target), link = fs::read_symlink(target, error);
        if (error || named.parent_path() == descriptor_folder())
            return named;
        target = named.parent_path() / link; // the link alone where it is absolute
    }
    throw Error(fmt::format("{}: {}", file.string(), std::strerror(ELOOP)));
}

std::optional<int> descriptor_of(const fs::path &file) {
    constexpr std::array standard = {"/dev/stdin", "/dev/stdout", "/dev/stderr"}; // also where there is no /proc
    if (const auto known = std::ranges::find(standard, file); known != standard.end())
        return int(known - standard.begin());
    const fs::path target = in_true_folder(target_of(file));
    if (descriptor_folder().empty() || target.parent_path() != descriptor_folder())
        return std::nullopt;
    const std::string name = target.filename().string();
    int descriptor = -1;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), descriptor);
    return error == std::errc() && *end == '\0' ? std::optional(descriptor) : std::nullopt;
}

bool is_same_file(const fs::path &a, const fs::path &b) {
    struct stat first {
    }, second{};
    const bool first_exists = stat(a.c_str(), &first) == 0, second_exists = stat(b.c_str(), &second) == 0;
    if (!first_exists || !second_exists)
        return first_exists == second_exists && in_true_folder(target_of(a)) == in_true_folder(target_of(b));
    const bool has_contents = S_ISREG(first.st_mode) || S_ISFIFO(first.st_mode);
    return has_contents && first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

void note_input(const fs::path &file) {
    const std::lock_guard lock(mutex);
    for (const fs::path &output : outputs)
        if (is_same_file(file, output))
            refuse(file, output, read_and_written);
    inputs.insert(fs::absolute(file));
}

void note_output(const fs::path &file) {
    const std::lock_guard lock(mutex);
    for (const fs::path &input : inputs)
        if (is_same_file(file, input))
            refuse(file, input, read_and_written);
    for (const fs::path &output : outputs)
        if (is_same_file(file, output))
            refuse(file, output, "would be written twice; give each output a file of its own");
    outputs.insert(fs::absolute(file));
}

void check_own_files(const fs::path &folder, const std::vector<std::string> &beginnings) {
    const std::lock_guard lock(mutex);
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const std::string name = at->path().filename().string();
        if (std::ranges::any_of(beginnings, [&](const std::string &start) { return name.starts_with(start); }))
            for (const fs::path &input : inputs)
                if (is_same_file(at->path(), input))
                    refuse(at->path(), input, read_and_written);
    }
}

} // namespace opal
