// Numbers and booleans from text, as XML attributes and command-line options give them. Each function throws Error that
// quotes the text. The caller adds the place.
#pragma once

#include "base/math.h"

#include <string>
#include <string_view>
#include <vector>

namespace opal {

bool parse_boolean(std::string_view text);  // true or false in any case
int parse_integer(std::string_view text);   // all of the text; blanks around it are allowed
double parse_number(std::string_view text); // all of the text; finite, also in single precision

// Exactly `count` numbers, separated by commas or blanks.
std::vector<double> parse_numbers(std::string_view text, size_t count);
Vec3 parse_triple(std::string_view text);

std::vector<std::string> lines_of(const std::string &text); // without their ends

// The words of a text, separated by commas or blanks.
std::vector<std::string_view> split(std::string_view text);

} // namespace opal
