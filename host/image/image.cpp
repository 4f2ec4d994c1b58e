#include "image/image.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace opal {

const Layer *Image::find(const std::string &name) const {
    const auto found =
        std::find_if(layers.begin(), layers.end(), [&](const Layer &layer) { return layer.name == name; });
    return found == layers.end() ? nullptr : &*found;
}

const Layer &Image::get(const std::string &name) const {
    if (const Layer *layer = find(name))
        return *layer;
    std::vector<std::string> names;
    for (const Layer &layer : layers)
        names.push_back(layer.name);
    throw Error(fmt::format("the image has no layer '{}'; available: {}", name, fmt::join(names, ", ")));
}

double Image::number(const std::string &attribute) const {
    const auto found = metadata.find(attribute);
    return found == metadata.end() ? 0 : std::strtod(found->second.c_str(), nullptr);
}

} // namespace opal
