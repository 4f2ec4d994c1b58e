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
    unsigned needs = 0;              // OPAL_NEEDS_*: what must be there for it to matter
};

std::span<const Axis> axes();                     // index = AXIS_* value
int find_choice(int axis, std::string_view name); // throws Error "unknown mis 'x'; available: balance, ..."

// A row of cl/integrators/list.h.
struct IntegratorTraits {
    const char *name; // as the list spells it: "direct_lighting"
    const char *loop; // the kernel file that drives it, without folder and ending
    unsigned asks;    // OPAL_ASKS_BSDFS and so on
    unsigned axes;    // a bit for each axis that it reads, beside `sampler`, which all read

    bool has(unsigned trait) const { return (asks & trait) != 0; }
    bool reads(int axis) const { return axis == AXIS_sampler || (axes >> axis & 1u) != 0; }
};

std::span<const IntegratorTraits> integrators(); // index = CHOICE_integrator_* value

// Whether the kernel is compiled for the scene, or is one for all scenes.
enum class Specialise { automatic, on, off };

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
    double rr_max = 0.9999;                // --rr throughput: greatest probability to survive
    unsigned emitter_samples = 1;          // of direct_lighting, where light is sampled
    unsigned bsdf_samples = 1;             // of direct_lighting, where the BSDF is sampled
    unsigned rr_depth = 3;                 // roulette from this many segments on
    unsigned max_depth = no_limit;         // segments of the longest path
    MathMode math = MathMode::precise;
    int lanes = 0; // 0: the device's width
    Specialise specialise = Specialise::automatic;
    bool few_paths = false; // are so few asked that `automatic` means the general kernel? (render/kernel_choice.h)

    // Does the kernel for all scenes render?
    bool is_general() const {
        return specialise == Specialise::off || (specialise == Specialise::automatic && few_paths);
    }

    int operator[](int axis) const { return choices[axis]; }
    int &operator[](int axis) { return choices[axis]; }
};

inline const IntegratorTraits &integrator_of(const Strategy &strategy) {
    return integrators()[static_cast<std::size_t>(strategy[AXIS_integrator])];
}

// Whether --mis one-sample means something: there are both kinds of samples, and an integrator that can take one.
bool can_take_one_sample(const Strategy &strategy);

// Whether directions are drawn: an integrator that asks no material needs another --hemisphere than `material`.
bool has_hemisphere(const Strategy &strategy);

// Whether points on emitters are sampled. An integrator that OPAL_ASKS_LIGHTS finds them by BSDF samples alone
// otherwise.
bool samples_emitters(const Strategy &strategy);

} // namespace opal
