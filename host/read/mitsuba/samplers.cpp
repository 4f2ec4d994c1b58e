// Parser of samplers: each becomes the one of Opal's that is nearest.
#include "read/mitsuba/parsers.h"

#include <fmt/format.h>

namespace opal::mitsuba {

namespace {

constexpr unsigned initial_count = 4; // samples a pixel

// Points that are stratified in each axis and in each pair of axes at once, as these two are, Sobol's are as well.
const std::vector<Plugin<int>> sampler_types = {
    {"independent", "independent", CHOICE_sampler_independent},
    {"stratified", "stratified", CHOICE_sampler_stratified},
    {"multijitter", "sobol", CHOICE_sampler_sobol},
    {"orthogonal", "sobol", CHOICE_sampler_sobol},
    {"ldsampler", "sobol", CHOICE_sampler_sobol},
};

} // namespace

void set_default_sampler(Sensor &sensor) {
    sensor.sampler = CHOICE_sampler_independent;
    sensor.spp = initial_count;
}

void parse_sampler(Importer &importer, Object &object, Sensor &sensor) {
    const auto *type = importer.row_of_type(object, sampler_types, "independent stands in for it");
    if (!type)
        return;
    sensor.sampler = type->parse;
    const std::optional<int> given = object.integer("sample_count");
    const int count = given.value_or(int(initial_count));
    object.check(count >= 1, "sample_count", "must be at least 1 sample per pixel");
    sensor.spp = unsigned(count);
    sensor.sample_count_given = given.has_value();
    sensor.sampler_place = object.place();
    object.ignore("seed"); // --seed
    if (type->name != "independent" && type->name != "ldsampler")
        object.check(object.boolean("jitter").value_or(true), "jitter",
                     "Opal jitters: without it, an image is not unbiased");
    if (type->name == "orthogonal")
        object.ignore("strength");
    object.finish();
}

} // namespace opal::mitsuba
