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

std::string Image::text(const std::string &attribute) const {
    const auto found = metadata.find(attribute);
    if (found == metadata.end())
        return "";
    const auto *text = std::get_if<std::string>(&found->second);
    return text ? *text : std::visit([](const auto &value) { return fmt::format("{}", value); }, found->second);
}

double Image::number(const std::string &attribute) const { return std::strtod(text(attribute).c_str(), nullptr); }

Crop Image::place() const { return crop == Crop{} ? Crop{0, 0, width, height, width, height} : crop; }

std::string text_of(const Crop &p) {
    const std::string size = fmt::format("{} x {}", p.width, p.height);
    return p.is_whole() ? size : fmt::format("{} at ({}, {}) of {} x {}", size, p.x, p.y, p.of_width, p.of_height);
}

Image cropped(const Image &image, const Crop &part) {
    const Crop from = image.place();
    Image result{part.width, part.height, {}, image.metadata, part.is_whole() ? Crop{} : part};
    for (const Layer &layer : image.layers) {
        Layer &own = result.layers.emplace_back(Layer{layer.name, {}});
        for (int y = part.y - from.y; y < part.y - from.y + part.height; y++) {
            const auto row = layer.values.begin() + std::ptrdiff_t(y) * image.width + (part.x - from.x);
            own.values.insert(own.values.end(), row, row + part.width);
        }
    }
    return result;
}

} // namespace opal
