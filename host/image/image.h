// Images of named float layers, and their files.
#pragma once

#include "base/crop.h"
#include "base/hash.h"
#include "base/large_vector.h"

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace opal {

struct Layer {
    std::string name;          // "R", "G", "B", "variance.R", ...
    std::vector<float> values; // width * height, top row first
};

using Attribute = std::variant<std::string, int, float>;

struct Image {
    int width = 0, height = 0;
    std::vector<Layer> layers;
    std::map<std::string, Attribute> metadata; // attributes of the EXR header
    Crop crop{};                               // all 0: the whole image
    bool is_luminance = false;                 // R, G and B are the one channel Y of a file

    const Layer *find(const std::string &name) const;     // nullptr where there is none
    const Layer &get(const std::string &name) const;      // Error that lists the layers
    double number(const std::string &attribute) const;    // from the metadata; 0 if it is missing or no number
    std::string text(const std::string &attribute) const; // from the metadata; empty if it is missing
    Crop place() const;                                   // crop, or that of the whole image
};

nlohmann::json json_of(const Crop &crop);
std::string text_of(const Crop &crop);               // "32 x 24", of a part: "8 x 8 at (16, 8) of 32 x 24"
Image cropped(const Image &image, const Crop &part); // the part, which the image must hold

// Reads every float and half channel of the part that holds the picture: of several parts the one named rgb, beauty or
// Combined, else the first with R, G, B. Channels r g b, X Y Z (CIE XYZ with white D65), Y alone and *.Combined.R, .G,
// .B become R, G, B. Notes tell what was chosen. A data window within a larger display window is a crop, as the
// attribute opal.crop is.
Image read_exr(const std::filesystem::path &file, FileHashes *hashes = nullptr); // hashes: gets that of the bytes

// The picture that a texture takes of an EXR, by the same rules; of a file of one channel that one, as grey. Others of
// its channels are not read.
struct ExrTexture {
    int width = 0, height = 0, channels = 0;
    LargeVector<float> values; // rows from the top, those of a pixel together
};
ExrTexture exr_size(const std::filesystem::path &file, std::string_view bytes); // without values. Notes what is chosen
ExrTexture exr_pixels(const std::filesystem::path &file, std::string_view bytes);

// Writes the form that most programs read right (measured): one part of scanlines, float32, ZIPS, both windows from
// (0, 0), colour space and chromaticities (Rec. 709) as attributes. Names of layers ("variance.R") must not begin with
// a, b, g, r or y, which ImageMagick 7 takes for alpha, blue, green and red. By write_safely.
void write_exr(const Image &image, const std::filesystem::path &file);
std::string exr_bytes(const Image &image); // the file that write_exr writes

// How a linear value is shown: it is multiplied by 2^exposure, then mapped, then clamped to 0 to 1 and sRGB-encoded.
enum class Tonemap {
    srgb, // as it is
    aces  // the ACES film curve: x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), the fit of Narkowicz, 2015
};
struct Display {
    double exposure = 0; // EV
    Tonemap tonemap = Tonemap::srgb;
};

// Writes R, G, B as sRGB (IEC 61966-2-1), rounded to 8 bits. Pixels that are not finite become magenta.
void write_png(const Image &image, const std::filesystem::path &file, const Display &display = {});
double srgb_encode(double linear); // of a linear value, clamped to 0 to 1

// Where the PNG of an EXR goes: beside it. Empty where nothing can be beside it: it is a FIFO, a device, /dev/stdout.
std::filesystem::path png_beside(const std::filesystem::path &exr);

// Throw Error where a file of that format cannot hold an image of that size. layers: those of an EXR.
void check_png_size(int width, int height);
void check_exr_size(int width, size_t layers);

// Makes a folder, and those above it, unless it is there. Throws Error with the reason of the system.
void make_folder(const std::filesystem::path &folder);

// Error unless write_safely could write this file. Call it before rendering, not after. Removes temporary files in the
// file's folder that killed processes left: those of this user that are a day old.
void check_writable(const std::filesystem::path &file);

// check_writable, and UsageError where the file is an input or another output (base/file_use.h): for the files that a
// command line names.
void check_output(const std::filesystem::path &file);

// Writes a temporary file (.opal-<random>.tmp) beside `file` and renames it when it is whole: no file is ever
// half-written. Error with the reason of the system ("No space left on device"); the temporary file is then removed, as
// it is if a signal but SIGKILL ends the process. Mode and owner of a file that is replaced stay. A symbolic link's
// target is written, also one that is not there yet. Devices and FIFOs are written in place; /dev/stdout, /dev/fd/3 and
// links to them through the open descriptor, as a shell's >> wants it. Throws InterruptedWait if a signal comes while
// it waits for a FIFO's reader.
void write_safely(const std::filesystem::path &file, const std::string &bytes);

} // namespace opal
