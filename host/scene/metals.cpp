#include "scene/metals.h"

namespace opal {

std::span<const Metal> metals() {
    static const Metal table[] = {
#include "scene/metals.inc"
        {"none", {0, 0, 0}, {1, 1, 1}},
    };
    return table;
}

const Metal *find_metal(const std::string &name) {
    for (const Metal &metal : metals())
        if (metal.name == name)
            return &metal;
    return nullptr;
}

} // namespace opal
