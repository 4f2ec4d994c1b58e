// Options that several commands share: the scene, its strategy overrides, the kernels' sources, the device.
#pragma once

#include "device/program.h"
#include "read/nori/load.h"

#include <CLI/CLI.hpp>

namespace opal {

struct SceneOptions {
    std::filesystem::path file;
    std::map<std::string, std::string> overrides; // for override_strategy: "lighting" -> "mis"
    LoadOptions load;
    std::string cl_dir; // empty: the embedded kernels
};

// --integrator, a flag for each strategy option, --lenient, --cl-dir.
void add_strategy_options(CLI::App &app, SceneOptions &options);
// The same and SCENE.xml.
void add_scene_options(CLI::App &app, SceneOptions &options);
void add_device_option(CLI::App &app, std::string &device); // --device, for pick_device

// Load, override, check. Throws Error.
SceneDescription load_scene(const SceneOptions &options);
Sources load_sources(const SceneOptions &options);

} // namespace opal
