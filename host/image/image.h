// Images of named float layers, and their files.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace opal {

struct Layer {
    std::string name;          // "R", "G", "B", "variance.R", ...
    std::vector<float> values; // width * height, top row first
};

struct Image {
    int width = 0, height = 0;
    std::vector<Layer> layers;
    std::map<std::string, std::string> metadata; // string attributes of the EXR header

    const Layer *find(const std::string &name) const;  // nullptr where there is none
    const Layer &get(const std::string &name) const;   // Error that lists the layers
    double number(const std::string &attribute) const; // from the metadata; 0 if it is missing or no number
};

Image read_exr(const std::filesystem::path &file);                     // reads every float and half channel
void write_exr(const Image &image, const std::filesystem::path &file); // float32; by write_safely
// Writes R, G, B with the exact sRGB curve (IEC 61966-2-1), clamped and rounded to 8 bits. Pixels that are not finite
// become magenta.
void write_png(const Image &image, const std::filesystem::path &file);
double srgb_encode(double linear); // of a linear value, clamped to 0 to 1

// Error unless write_safely could write this file. Call it before rendering, not after.
void check_writable(const std::filesystem::path &file);

// Writes a temporary file beside `file` and renames it when it is whole: no file is ever half-written. Error with the
// reason of the system ("No space left on device"); the temporary file is then removed. A symbolic link's target is
// replaced, not the link. A file that is not regular (/dev/stdout) is written in place.
void write_safely(const std::filesystem::path &file, const std::string &bytes);

} // namespace opal
