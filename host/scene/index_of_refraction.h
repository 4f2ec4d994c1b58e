// Indices of refraction by the names of media.
#pragma once

#include <optional>
#include <span>
#include <string>

namespace opal {

struct Medium {
    std::string name; // in lower case: "water ice"
    double index;     // of refraction, for visible light
};
std::span<const Medium> media(); // the 23 that Mitsuba 3 knows, with its values

// The index of the medium of that name, in any case; nothing where no medium has it.
std::optional<double> index_of_refraction(const std::string &name);

} // namespace opal
