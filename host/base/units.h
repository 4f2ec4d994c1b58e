// Amounts with units, as the command line takes them. Each function throws Error that quotes the text and says what is
// possible.
#pragma once

#include <string>

namespace opal {

double parse_seconds(const std::string &text);  // "30", "30s", "500ms", "2min", "1h"; above 0
double parse_fraction(const std::string &text); // "1%", "0.01"; above 0, below 1

} // namespace opal
