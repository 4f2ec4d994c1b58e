// The parser of BSDFs: their parameters are those of cl/bsdfs/NAME.h, by their names in the XML.
#include "read/nori/parsers.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace opal {

namespace {

struct BsdfType {
    std::string name;
    std::vector<uint> words; // its record with all defaults
};

#define OPAL_BSDF_TYPE(name, traits) {#name, words_of(bsdf_##name##_record{})},
const std::vector<BsdfType> bsdf_types = {OPAL_BSDFS(OPAL_BSDF_TYPE)};

// Numbers are checked as the device will see them, in single precision.
uint checked_word(const Properties &properties, const Parameter &parameter, double value) {
    const float number = static_cast<float>(value);
    properties.check(parameter.range.holds(number), parameter.xml_name,
                     fmt::format("must be {}: {}", text_of(parameter), parameter.meaning));
    return std::bit_cast<uint>(number);
}

// Sets the words of a parameter that the object has.
void read_parameter(Properties &properties, const Parameter &parameter, std::span<uint> words) {
    switch (parameter.type) {
    case ParameterType::COLOR:
        if (const auto color = properties.color(parameter.xml_name))
            for (size_t i = 0; i < 3; i++)
                words[parameter.word + i] = checked_word(properties, parameter, (*color)[i]);
        break;
    case ParameterType::NUMBER:
        if (const auto number = properties.number(parameter.xml_name))
            words[parameter.word] = checked_word(properties, parameter, *number);
        break;
    case ParameterType::FLAG:
        if (const auto flag = properties.boolean(parameter.xml_name))
            words[parameter.word] = *flag;
        break;
    }
}

} // namespace

Bsdf parse_bsdf(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context);
    Bsdf bsdf;
    bsdf.place = node.place();
    bsdf.words = row_of_type(node, bsdf_types).words;
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
        read_parameter(properties, parameter, bsdf.words);
    properties.ignore("use_cosine"); // exporters write it for every material
    properties.finish();
    return bsdf;
}

} // namespace opal
