#include "scene/index_of_refraction.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace opal {

std::span<const Medium> media() {
    static const Medium table[] = {
        {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
        {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
        {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
        {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
        {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
        {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
        {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
        {"pet", 1.575},       {"diamond", 2.419},
    };
    return table;
}

double principled_index(std::optional<double> eta, std::optional<double> specular, bool transmits) {
    if (eta)
        return transmits && *eta == 1 ? 1.001 : *eta;
    const double level = specular.value_or(0.5);
    return 2 / (1 - std::sqrt(0.08 * (transmits && level == 0 ? 1e-3 : level))) - 1;
}

std::optional<double> index_of_refraction(const std::string &name) {
    std::string small = name;
    std::ranges::transform(small, small.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    for (const Medium &medium : media())
        if (medium.name == small)
            return medium.index;
    return {};
}

} // namespace opal
