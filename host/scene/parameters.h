// The parameters of kinds (cl/shared/parameters.h) as tables: how to read, print and explain them without knowing the
// kind.
#pragma once

#include "bsdfs/list.h"
#include "emitters/list.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace opal {

// The numbers that a parameter may be.
struct ValueRange {
    double least = -INFINITY, most = INFINITY;
    bool without_least = false; // `least` itself is no such number
    bool without_most = false;
    bool holds(double x) const {
        return (without_least ? x > least : x >= least) && (without_most ? x < most : x <= most);
    }
};
constexpr ValueRange ANY{};
constexpr ValueRange AT_LEAST(double least) { return {least}; }
constexpr ValueRange ABOVE(double least) { return {least, INFINITY, true}; }
constexpr ValueRange BETWEEN(double least, double most) { return {least, most}; }
constexpr ValueRange INSIDE(double least, double most) { return {least, most, true, true}; }

constexpr double REQUIRED = NAN; // in place of a default

enum class ParameterType { COLOR, NUMBER, FLAG, BSDF, POINT, VECTOR, IMAGE, TRANSFORM, CURVE };

// Whether a file or the command line gives it as a property.
inline bool is_property(ParameterType type) { return type != ParameterType::BSDF && type != ParameterType::CURVE; }

struct Parameter {
    ParameterType type;
    std::string name;     // as a record's member: "int_ior"
    std::string xml_name; // "intIOR"
    double initial;       // of each channel or coordinate; 0 or 1 of a flag; NaN: REQUIRED
    ValueRange range;
    std::string meaning;
    size_t word;         // of a BSDF's record: the parameter's first one ...
    size_t texture_word; // ... and that of its texture; 0: it cannot have one, as no number of a kind with a CURVE
};

std::span<const Parameter> bsdf_parameters(uint kind);             // kind: BSDF_*
const Parameter *bsdf_parameter(uint kind, std::string_view name); // that of the record's member `name`, or null
std::span<const Parameter> emitter_parameters(uint kind);          // kind: EMITTER_*; none of emitters of meshes

std::string text_of(const ValueRange &range);            // what a number may be: "0 or more", "above 0"
std::string text_of(const Parameter &parameter);         // what it may be: "above 0", "true or false"
std::string text_of_initial(const Parameter &parameter); // "0.5", "false"
const char *xml_tag(ParameterType type);                 // "color", "float", "boolean", "point"

// A record as words, and back. `at`: index of its first word.
template <class Record> using WordsOf = std::array<uint, sizeof(Record) / sizeof(uint)>;
template <class Record> std::vector<uint> words_of(const Record &record) {
    const auto words = std::bit_cast<WordsOf<Record>>(record);
    return {words.begin(), words.end()};
}
template <class Record> Record record_of(std::span<const uint> words, size_t at = 0) {
    WordsOf<Record> own;
    std::copy_n(words.begin() + std::ptrdiff_t(at), own.size(), own.begin());
    return std::bit_cast<Record>(own);
}

// Whether a BSDF's record has another alpha_u than alpha_v, or another texture.
bool is_anisotropic(std::span<const uint> words);

} // namespace opal
