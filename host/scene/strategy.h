// Strategy: how a scene is rendered. One choice for each axis of cl/shared/strategy.h, and a few numbers.
#pragma once

#include "shared/strategy.h"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace opal {

struct Choice {
    std::string name; // as typed: "throughput-eta"
    std::string help;
};

struct Axis {
    std::string name; // as typed: "emitter-choice"
    std::string help;
    std::span<const Choice> choices; // index = CHOICE_* value
};

std::span<const Axis> axes();                     // index = AXIS_* value
int find_choice(int axis, std::string_view name); // throws Error "unknown mis 'x'; available: balance, ..."

enum class MathMode { precise, fast, double_precision };

// As typed (--math), indexed by MathMode.
struct MathModeRow {
    std::string name, help;
};
std::span<const MathModeRow> math_modes();
inline const std::string &name_of(MathMode mode) { return math_modes()[static_cast<std::size_t>(mode)].name; }

constexpr unsigned no_limit = 0xffffffffu;

struct Strategy {
    std::array<int, AXIS_COUNT> choices{}; // CHOICE_* of each AXIS_*
    double rr_prob = 0.95;                 // --rr fixed
    unsigned rr_depth = 3;                 // roulette from this many segments on
    unsigned max_depth = no_limit;         // segments of the longest path
    MathMode math = MathMode::precise;
    int lanes = 0; // 0: the device's width
    bool specialise = true;

    int operator[](int axis) const { return choices[axis]; }
    int &operator[](int axis) { return choices[axis]; }
};

} // namespace opal
