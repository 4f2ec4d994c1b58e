#include "scene/parameters.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>

namespace opal {

namespace {

// The place of a parameter's texture, given that of its first word and its type.
size_t texture_word(ParameterType type, size_t word) {
    switch (type) {
    case ParameterType::COLOR:
        return word + offsetof(ColorParameter, texture) / sizeof(uint);
    case ParameterType::NUMBER:
        return word + offsetof(NumberParameter, texture) / sizeof(uint);
    default:
        return 0;
    }
}

// The rows of a kind, of which no number has a texture if a CURVE depends on the numbers.
std::vector<Parameter> without_textures_of_curves(std::vector<Parameter> rows) {
    if (std::ranges::find(rows, ParameterType::CURVE, &Parameter::type) != rows.end())
        for (Parameter &row : rows)
            if (row.type == ParameterType::NUMBER)
                row.texture_word = 0;
    return rows;
}

} // namespace

std::span<const Parameter> bsdf_parameters(uint kind) {
#define OPAL_WORD(name) (offsetof(Record, name) / sizeof(uint))
#define OPAL_PARAMETER_ROW(type, name, xml, initial, range, meaning)                                                   \
    {ParameterType::type,                                                                                              \
     #name,                                                                                                            \
     xml,                                                                                                              \
     initial,                                                                                                          \
     range,                                                                                                            \
     meaning,                                                                                                          \
     OPAL_WORD(name),                                                                                                  \
     texture_word(ParameterType::type, OPAL_WORD(name))},
#define OPAL_BSDF_PARAMETERS(name, traits)                                                                             \
    [] {                                                                                                               \
        using Record [[maybe_unused]] = bsdf_##name##_record;                                                          \
        return without_textures_of_curves({OPAL_BSDF_##name(OPAL_PARAMETER_ROW)});                                     \
    }(),
    static const std::vector<Parameter> tables[] = {OPAL_ALL_BSDFS(OPAL_BSDF_PARAMETERS)};
    return tables[kind];
}

const Parameter *bsdf_parameter(uint kind, std::string_view name) {
    const auto parameters = bsdf_parameters(kind);
    const auto found = std::ranges::find(parameters, name, &Parameter::name);
    return found == parameters.end() ? nullptr : &*found;
}

bool is_anisotropic(std::span<const uint> words) {
    const Parameter *const u = bsdf_parameter(words[0], "alpha_u"), *const v = bsdf_parameter(words[0], "alpha_v");
    return u && v && (words[u->word] != words[v->word] || words[u->texture_word] != words[v->texture_word]);
}

std::span<const Parameter> emitter_parameters(uint kind) {
#define OPAL_VALUE_ROW(type, name, xml, initial, range, meaning)                                                       \
    {ParameterType::type, #name, xml, initial, range, meaning, 0, 0},
#define OPAL_NO_PARAMETERS(name, traits) {},
#define OPAL_EMITTER_PARAMETERS(name, traits) {OPAL_EMITTER_##name(OPAL_VALUE_ROW)},
    static const std::vector<Parameter> tables[] = {OPAL_MESH_EMITTERS(OPAL_NO_PARAMETERS)
                                                        OPAL_SCENE_EMITTERS(OPAL_EMITTER_PARAMETERS)};
    return tables[kind];
}

std::string text_of(const Parameter &parameter) {
    return parameter.type == ParameterType::FLAG    ? "true or false"
           : parameter.type == ParameterType::IMAGE ? "a file"
                                                    : text_of(parameter.range);
}

std::string text_of(const ValueRange &range) {
    if (std::isinf(range.least) && std::isinf(range.most))
        return "any";
    if (range.without_most)
        return fmt::format("above {:g} and below {:g}", range.least, range.most);
    if (!std::isinf(range.most))
        return fmt::format("{:g} to {:g}", range.least, range.most);
    return range.without_least ? fmt::format("above {:g}", range.least) : fmt::format("{:g} or more", range.least);
}

std::string text_of_initial(const Parameter &parameter) {
    if (parameter.type == ParameterType::FLAG)
        return parameter.initial != 0 ? "true" : "false";
    if (std::isnan(parameter.initial))
        return "required";
    if (parameter.type == ParameterType::TRANSFORM)
        return "none";
    return fmt::format("{:g}", parameter.initial);
}

const char *xml_tag(ParameterType type) {
    static const char *const tags[] = {"color", "float", "boolean", "bsdf", "point", "vector", "string", "transform"};
    return tags[static_cast<size_t>(type)];
}

} // namespace opal
