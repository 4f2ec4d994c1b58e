// The report of a render: one JSON object, for --json and for the header of the EXR.
#pragma once

#include "device/context.h"
#include "film/film.h"
#include "scene/scene.h"

#include <nlohmann/json.hpp>

namespace opal {

// Seconds of the stages of a render, in wall time except for `render`, which is kernel time.
struct RenderSeconds {
    double load = 0, bvh = 0, compile = 0, render = 0, write = 0;
};

// The strategy: a key for each axis with the choice's name on the command line, and the numeric options.
nlohmann::json strategy_json(const SceneDescription &scene);

// Device, strategy, statistics of the film, seconds, warnings and version. Luminances and colours are radiances.
nlohmann::json report_json(const SceneDescription &scene, const DeviceInfo &device, int lanes, unsigned seed,
                           const Film &film, const RenderSeconds &seconds);

// Adds the report to the image's metadata, which become header attributes: "opal.KEY" for each key.
void add_metadata(Image &image, const nlohmann::json &report, const std::string &command_line);

} // namespace opal
