// A canvas for plots: an image with rectangles and small text.
#pragma once

#include "image/image.h"

#include <array>
#include <string_view>

namespace opal {

using Ink = std::array<double, 3>; // as displayed (sRGB), 0 to 1

class Canvas {
public:
    Canvas(int width, int height, Ink paper);
    void fill(int x, int y, int width, int height, Ink ink); // parts outside the canvas are cut off
    // Capital letters, digits and . , - + = / ( ) : %, each 4 x 6 dots of `size` pixels; (x, y) is the top left corner.
    void text(int x, int y, std::string_view words, int size, Ink ink);
    static int text_width(std::string_view words, int size) { return int(words.size()) * 4 * size; }
    const Image &image() const { return image_; }

private:
    Image image_;
};

Ink viridis(double t);        // 0 to 1
Ink blue_white_red(double t); // -1 to 1

} // namespace opal
