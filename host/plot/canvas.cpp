#include "plot/canvas.h"

#include "base/srgb.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace opal {

namespace {

// 3 x 5 dots: five octal digits, a row each, the highest bit left.
struct Glyph {
    char letter;
    unsigned rows;
};
constexpr Glyph glyphs[] = {{'0', 075557}, {'1', 026227}, {'2', 071747}, {'3', 071717}, {'4', 055711}, {'5', 074717},
                            {'6', 074757}, {'7', 071111}, {'8', 075757}, {'9', 075717}, {'A', 025755}, {'B', 065656},
                            {'C', 034443}, {'D', 065556}, {'E', 074647}, {'F', 074644}, {'G', 034553}, {'H', 055755},
                            {'I', 072227}, {'J', 011152}, {'K', 055655}, {'L', 044447}, {'M', 057755}, {'N', 065555},
                            {'O', 025552}, {'P', 065644}, {'Q', 025563}, {'R', 065655}, {'S', 034216}, {'T', 072222},
                            {'U', 055557}, {'V', 055552}, {'W', 055775}, {'X', 055255}, {'Y', 055222}, {'Z', 071247},
                            {'.', 000002}, {',', 000024}, {'-', 000700}, {'+', 002720}, {'=', 007070}, {'/', 011244},
                            {'(', 012221}, {')', 042224}, {':', 002020}, {'%', 051245}, {'_', 000007}, {'^', 025000}};

unsigned rows_of(char letter) {
    const char upper = char(std::toupper(static_cast<unsigned char>(letter)));
    for (const Glyph &glyph : glyphs)
        if (glyph.letter == upper)
            return glyph.rows;
    return 0; // a blank
}

} // namespace

Canvas::Canvas(int width, int height, Ink paper) {
    image_.width = width;
    image_.height = height;
    for (const char *name : {"R", "G", "B"})
        image_.layers.push_back({name, std::vector<float>(size_t(width) * size_t(height))});
    fill(0, 0, width, height, paper);
}

void Canvas::fill(int x, int y, int width, int height, Ink ink) {
    const int right = std::min(x + width, image_.width), bottom = std::min(y + height, image_.height);
    for (size_t c = 0; c < 3; c++)
        for (int row = std::max(y, 0); row < bottom; row++)
            for (int column = std::max(x, 0); column < right; column++)
                image_.layers[c].values[size_t(row) * size_t(image_.width) + size_t(column)] =
                    float(srgb_decode(ink[c]));
}

void Canvas::text(int x, int y, std::string_view words, int size, Ink ink) {
    for (char letter : words) {
        const unsigned rows = rows_of(letter);
        for (int row = 0; row < 5; row++)
            for (int column = 0; column < 3; column++)
                if (rows >> (14 - 3 * row - column) & 1)
                    fill(x + column * size, y + row * size, size, size, ink);
        x += 4 * size;
    }
}

// The map "viridis" of matplotlib (Smith and van der Walt 2015), by linear interpolation between nine of its colours.
Ink viridis(double t) {
    static constexpr double stops[9][3] = {{0.267, 0.005, 0.329}, {0.279, 0.175, 0.483}, {0.230, 0.322, 0.546},
                                           {0.173, 0.449, 0.558}, {0.128, 0.567, 0.551}, {0.158, 0.684, 0.502},
                                           {0.369, 0.789, 0.383}, {0.678, 0.864, 0.190}, {0.993, 0.906, 0.144}};
    const double place = std::clamp(t, 0.0, 1.0) * 8;
    const int i = std::min(int(place), 7);
    Ink ink{};
    for (size_t c = 0; c < 3; c++)
        ink[c] = stops[i][c] + (place - i) * (stops[i + 1][c] - stops[i][c]);
    return ink;
}

Ink blue_white_red(double t) {
    const double a = std::clamp(std::abs(t), 0.0, 1.0);
    const Ink end = t < 0 ? Ink{0.13, 0.40, 0.67} : Ink{0.70, 0.09, 0.17};
    Ink ink{};
    for (size_t c = 0; c < 3; c++)
        ink[c] = 0.97 + a * (end[c] - 0.97);
    return ink;
}

} // namespace opal
