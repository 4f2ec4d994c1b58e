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

// The index that a principled BSDF has inside over outside: eta, or that whose reflectance at normal incidence is 0.08
// specular (Burley 2012, "Physically Based Shading at Disney", section 5.5); neither: specular 0.5. transmits: then 1,
// at which nothing bends, gives way to an index beside it, the same as in Mitsuba.
double principled_index(std::optional<double> eta, std::optional<double> specular, bool transmits);

// The index of the medium of that name, in any case; nothing where no medium has it.
std::optional<double> index_of_refraction(const std::string &name);

} // namespace opal
