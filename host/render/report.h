// What a render tells of itself: one JSON object, for --json and for the EXR's header.
#pragma once

#include "device/context.h"
#include "film/film.h"
#include "scene/scene.h"

#include <nlohmann/json.hpp>

namespace opal {

struct RenderSeconds {
    double load = 0, bvh = 0, compile = 0, render = 0 /* kernel time */, write = 0;
};

// One key an axis, as the command line names choices, and the numbers that go with them.
nlohmann::json strategy_json(const SceneDescription &scene);

nlohmann::json report_json(const SceneDescription &scene, const DeviceInfo &device, int lanes, unsigned seed,
                           const Film &film, const RenderSeconds &seconds);

// The same as header attributes of an image.
void add_metadata(Image &image, const nlohmann::json &report, const std::string &command_line);

} // namespace opal
