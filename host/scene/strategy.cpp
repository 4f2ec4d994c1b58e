#include "scene/strategy.h"

#include "base/table.h"

namespace opal {

std::span<const Axis> axes() {
#define OPAL_CHOICE_ROW(axis, choice, help) {with_hyphens(#choice), help},
#define OPAL_AXIS_CHOICES(axis, needs, help)                                                                           \
    static const Choice choices_##axis[] = {OPAL_CHOICES_##axis(OPAL_CHOICE_ROW)};
#define OPAL_AXIS_ROW(axis, needs, help) {with_hyphens(#axis), help, choices_##axis, needs},
    OPAL_AXES(OPAL_AXIS_CHOICES)
    static const Axis table[] = {OPAL_AXES(OPAL_AXIS_ROW)};
    return table;
}

std::span<const IntegratorTraits> integrators() {
#define OPAL_INTEGRATOR_ROW(with, name, loop, asks, axes, help) {#name, #loop, asks, axes},
    static const IntegratorTraits table[] = {OPAL_INTEGRATORS(OPAL_INTEGRATOR_ROW, )};
    return table;
}

bool can_take_one_sample(const Strategy &strategy) {
    return integrator_of(strategy).has(OPAL_ONE_SAMPLE_MIS) && strategy[AXIS_lighting] == CHOICE_lighting_mis;
}

bool has_hemisphere(const Strategy &strategy) {
    const IntegratorTraits &integrator = integrator_of(strategy);
    return strategy[AXIS_hemisphere] != CHOICE_hemisphere_material || integrator.has(OPAL_ASKS_BSDFS) ||
           !integrator.reads(AXIS_hemisphere);
}

bool samples_emitters(const Strategy &strategy) {
    const IntegratorTraits &integrator = integrator_of(strategy);
    return integrator.has(OPAL_ASKS_LIGHTS) &&
           !(integrator.reads(AXIS_lighting) && strategy[AXIS_lighting] == CHOICE_lighting_bsdf);
}

std::span<const MathModeRow> math_modes() {
    static const MathModeRow table[] = {
        {"precise", "single precision, as IEEE 754 has it"},
        {"fast", "single precision, relaxed math and native functions"},
        {"double", "double precision: the oracle that single precision is held against (opal extremes)"}};
    return table;
}

int find_choice(int axis, std::string_view name) {
    const Axis &row = axes()[axis];
    const Choice &choice = find_row(row.choices, row.name, with_hyphens(std::string(name)));
    return static_cast<int>(&choice - row.choices.data());
}

} // namespace opal
