// An image of named float layers, and the files it is kept in.
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
    const Layer &get(const std::string &name) const;   // Error naming the layers there are
    double number(const std::string &attribute) const; // of the metadata; 0 where it is missing or no number
};

Image read_exr(const std::filesystem::path &file);                     // every float or half channel
void write_exr(const Image &image, const std::filesystem::path &file); // float32, beside and then renamed
// R, G, B with the exact sRGB curve (IEC 61966-2-1), clamped and rounded to 8 bits; what is not finite becomes magenta.
void write_png(const Image &image, const std::filesystem::path &file);
double srgb_encode(double linear); // linear 0 to 1 -> display value 0 to 1, clamped

// Throws Error unless write_safely could put a file there: asked before rendering, not after.
void check_writable(const std::filesystem::path &file);

// Writes by way of a temporary file beside `file`, renamed when `write` has returned: nothing is ever half-written.
// Throws Error with the reason of the system ("No space left on device") and removes the temporary file.
// A link's target is written, not the link; what is no regular file (/dev/stdout) is written as it is.
void write_safely(const std::filesystem::path &file, const std::string &bytes);

} // namespace opal
