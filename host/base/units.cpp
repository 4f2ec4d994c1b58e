#include "base/units.h"

#include "base/error.h"

#include <cmath>
#include <cstdlib>

namespace opal {

namespace {

struct Unit {
    const char *name;
    double size;
};

// The number before one of the units; NaN where the text is no number with such a unit.
template <size_t N> double read(const std::string &text, const Unit (&units)[N]) {
    char *end = nullptr;
    const double number = std::strtod(text.c_str(), &end);
    if (end == text.c_str())
        return NAN;
    for (const Unit &unit : units)
        if (std::string(end) == unit.name)
            return number * unit.size;
    return NAN;
}

} // namespace

double parse_seconds(const std::string &text) {
    const double seconds = read(text, {{"", 1}, {"s", 1}, {"ms", 1e-3}, {"min", 60}, {"m", 60}, {"h", 3600}});
    if (!(seconds > 0) || !std::isfinite(seconds))
        throw Error("'" + text + "' is no duration above 0; possible: 30s, 500ms, 2min, 1h");
    return seconds;
}

double parse_fraction(const std::string &text) {
    const double fraction = read(text, {{"", 1}, {"%", 0.01}});
    if (!(fraction > 0 && fraction < 1))
        throw Error("'" + text + "' is no relative error above 0 and below 1; possible: 1%, 0.01");
    return fraction;
}

} // namespace opal
