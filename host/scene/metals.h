// Metals by name.
#pragma once

#include "base/color.h"

#include <span>
#include <string>

namespace opal {

struct Metal {
    std::string name; // "Au"
    Color eta, k;     // index of refraction eta - i k, linear RGB
};
std::span<const Metal> metals(); // the 71 that Mitsuba 3 knows, and "none", which reflects everything

// The metal of that name, upper and lower case as there; null where there is none.
const Metal *find_metal(const std::string &name);

} // namespace opal
