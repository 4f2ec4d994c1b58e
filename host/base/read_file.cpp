#include "base/read_file.h"

#include "base/error.h"
#include "base/memory.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <stdexcept>

namespace opal {

namespace fs = std::filesystem;

namespace {

// C's streams: C++'s do not tell a failed read from the end of a file.
std::string read_stream(std::FILE *stream, const fs::path &file) {
    std::error_code unknown; // set for pipes and devices, which have no size and are read to their end
    const auto size = fs::file_size(file, unknown);
    if (!unknown)
        check_memory(double(size), file.string() + ": cannot read");
    std::string bytes(unknown ? 65536 : size + 1,
                      '\0'); // one byte more than the size, so that the end is seen without growing
    size_t count = 0;
    for (;;) {
        count += std::fread(bytes.data() + count, 1, bytes.size() - count, stream);
        if (std::ferror(stream))
            cannot_read(file, errno);
        if (count < bytes.size())
            break;
        bytes.resize(2 * count);
    }
    if (!unknown && count < size)
        throw Error(fmt::format("{}: cannot read: it ended after {} of {} bytes", file.string(), count, size));
    bytes.resize(count);
    return bytes;
}

} // namespace

std::string read_file(const fs::path &file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored))
        throw Error(file.string() + ": is a folder, not a file");
    const std::unique_ptr<std::FILE, int (*)(std::FILE *)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
    if (!stream)
        cannot_read(file, errno);
    try {
        return read_stream(stream.get(), file);
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
