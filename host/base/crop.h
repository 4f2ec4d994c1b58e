// Crop: a part of an image.
#pragma once

namespace opal {

// The part of a larger image that an image shows, in pixels from the top left of the larger one.
struct Crop {
    int x = 0, y = 0, width = 0, height = 0;
    int of_width = 0, of_height = 0; // of the larger image
    bool operator==(const Crop &) const = default;
    bool is_whole() const { return *this == Crop{0, 0, of_width, of_height, of_width, of_height}; }
};

} // namespace opal
