#include "read/picture.h"

#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/read_file.h"
#include "image/image.h"
#include "read/file_kind.h"
#include "read/picture_formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace opal {
namespace {

// Adds the file's name, but to an Error, which has it.
template <class Read> auto reading(const std::filesystem::path &file, const char *format, Read read) {
    try {
        return read();
    } catch (const Error &) {
        throw;
    } catch (const std::runtime_error &error) {
        throw Error(fmt::format("{}: cannot be read as {}: {}", file.string(), format, error.what()));
    }
}

PictureHeader exr_header(const std::filesystem::path &file, std::string_view bytes) {
    const ExrTexture size = exr_size(file, bytes); // checks the file's size itself
    const double values = double(size.width) * size.height * size.channels;
    return {{size.width, size.height, size.channels, {}, {}, false}, 0, values * sizeof(float)};
}

struct Format {
    FileKind kind;
    const char *name;
    std::vector<const char *> endings;
    PictureHeader (*header)(const std::filesystem::path &file, std::string_view bytes);
    void (*decode)(std::string_view bytes, Picture &picture); // null: OpenEXR, which needs the name
};
const std::array<Format, 4> formats = {{
    {FileKind::png, "PNG", {".png"}, png_header, decode_png},
    {FileKind::jpeg, "JPEG", {".jpg", ".jpeg", ".jpe", ".jfif"}, jpeg_header, decode_jpeg},
    {FileKind::hdr, "Radiance HDR", {".hdr", ".pic", ".rgbe"}, hdr_header, decode_hdr},
    {FileKind::exr, "OpenEXR", {".exr"}, exr_header, nullptr},
}};

const Format &format_of(const std::filesystem::path &file, std::string_view bytes) {
    const FileKindRow found = kind_of(bytes);
    const auto format = std::ranges::find(formats, found.kind, &Format::kind);
    if (format == formats.end())
        throw Error(wrong_kind_text(file, found, FileKind::picture));
    return *format;
}

void note_other_ending(const std::filesystem::path &file, const Format &format) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    for (const Format &other : formats)
        if (other.kind != format.kind && std::ranges::find(other.endings, ending) != other.endings.end())
            note(fmt::format("{}: is {}, whatever its ending says", file.string(), format.name));
}

// Counts what is no usual texel, and makes NaN and infinite values 0. Returns how many there were.
std::size_t check_values(Picture &picture) {
    std::size_t invalid = 0;
    for (float &value : picture.floats) {
        if (!std::isfinite(value)) {
            value = 0;
            invalid++;
        }
        picture.negative += value < 0;
        picture.above_one += value > 1;
    }
    return invalid;
}

} // namespace

PictureFile::PictureFile(std::filesystem::path file, FileHashes *hashes)
    : file_(std::move(file)), bytes_(read_file(file_, Pipes::refused)) {
    const Format &format = format_of(file_, bytes_);
    if (hashes)
        hashes->add(bytes_);
    note_other_ending(file_, format);
    PictureHeader header = reading(file_, format.name, [&] { return format.header(file_, bytes_); });
    header_ = std::move(header.picture);
    if (double(bytes_.size()) < header.file_bytes)
        throw Error(fmt::format("{}: {} bytes cannot hold {} x {} pixels", file_.string(), bytes_.size(), header_.width,
                                header_.height));
    check_memory(header.memory_bytes,
                 fmt::format("{}: an image of {} x {} pixels", file_.string(), header_.width, header_.height));
}

Picture PictureFile::decode(std::size_t &invalid) const {
    const Format &format = format_of(file_, bytes_);
    Picture picture = header_;
    reading(file_, format.name, [&] {
        if (format.decode)
            format.decode(bytes_, picture);
        else
            picture.floats = exr_pixels(file_, bytes_).values;
    });
    invalid = check_values(picture);
    return picture;
}

Picture read_picture(const std::filesystem::path &file, FileHashes *hashes) {
    std::size_t invalid = 0;
    Picture picture = PictureFile(file, hashes).decode(invalid);
    warn_of_invalid(file, invalid);
    return picture;
}

void warn_of_invalid(const std::filesystem::path &file, std::size_t invalid) {
    if (invalid > 0)
        warn(fmt::format("{}: {} values are NaN or infinite: they are taken as 0", file.string(), invalid));
}

} // namespace opal
