// The textures of materials, in double precision.
#pragma once

#include "base/color.h"
#include "base/large_vector.h"
#include "textures/list.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>

namespace opal {

// The map from a surface's texture coordinates (u, v, 1) to the texture's own.
using UvTransform = std::array<std::array<double, 3>, 2>;
constexpr UvTransform identity_uv = {{{1, 0, 0}, {0, 1, 0}}};

struct CheckerboardTexture { // two by two squares in the unit square
    Color color0{0.4, 0.4, 0.4}, color1{0.2, 0.2, 0.2};
    UvTransform to_uv = identity_uv;
};

// The values of an image file: rows from the top, `channels` values a pixel, 1 (grey) or 3 (R, G, B; Rec. 709).
struct Picture {
    int width = 0, height = 0, channels = 0;
    LargeVector<std::uint8_t> bytes;         // of an image of 8 bits, as the file has them
    LargeVector<float> floats;               // of others: linear, or in [0, 1] as the file has them
    bool encoded = false;                    // whether the file means values of sRGB's curve
    std::size_t negative = 0, above_one = 0; // how many floats are
};

struct BitmapTexture {
    std::shared_ptr<const Picture> picture;
    bool raw = false; // the values are numbers, whatever the file means
    bool nearest = false;
    uint wrap = WRAP_repeat;
    UvTransform to_uv = identity_uv;
    bool full_precision = false; // values of 16 bits as they are, not rounded to half floats
};

struct MeshAttribute;

struct MeshAttributeTexture {
    std::string name; // "vertex_color", "face_color"
    double scale = 1;
    std::shared_ptr<const MeshAttribute> attribute; // that of the mesh; null before the mesh is known
};

using Texture = std::variant<CheckerboardTexture, BitmapTexture, MeshAttributeTexture>;

} // namespace opal
