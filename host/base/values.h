// Numbers and truths from text, as XML attributes and command-line options give them. Each throws Error (without a
// place: the caller knows it) that quotes what it read.
#pragma once

#include "base/math.h"

#include <string>
#include <string_view>
#include <vector>

namespace opal {

bool parse_boolean(std::string_view text);  // true or false in any case
int parse_integer(std::string_view text);   // the whole text, but for blanks around it
double parse_number(std::string_view text); // finite, also in single precision; the whole text

// Exactly `count` numbers between commas and blanks.
std::vector<double> parse_numbers(std::string_view text, size_t count);
Vec3 parse_triple(std::string_view text);

// Non-empty pieces between commas and blanks.
std::vector<std::string_view> split(std::string_view text);

} // namespace opal
