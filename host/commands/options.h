// Options that several commands share: the scene, its strategy overrides, the kernels' sources, the device.
#pragma once

#include "commands/command.h"
#include "device/context.h"
#include "device/sources.h"
#include "read/nori/load.h"

namespace opal {

struct SceneOptions {
    std::filesystem::path file;
    std::map<std::string, std::string> overrides; // for override_strategy: "lighting" -> "mis"
    LoadOptions load;
    std::string cl_dir; // empty: the embedded kernels
};

// --integrator, a flag for each strategy option, --lenient, --cl-dir.
std::vector<OptionRow> strategy_rows(SceneOptions &options);
// SCENE.xml and the same.
std::vector<OptionRow> scene_rows(SceneOptions &options);
OptionRow device_row(std::string &device); // --device, for pick_device
OptionRow cl_dir_row(std::string &cl_dir); // --cl-dir, for load_sources

// Load, override, check. Throws Error.
SceneDescription load_scene(const SceneOptions &options);
// The device that renders the scene, and the kernel's width and math there.
struct KernelChoice {
    DevicePick pick;
    BuildOptions build;
};
KernelChoice choose_kernel(const std::string &device, const SceneDescription &scene);

// The kernels' sources in that folder; empty: the embedded ones.
Sources load_sources(const std::string &cl_dir);

// The image's size in pixels where one is given (0: none). One side alone keeps the aspect.
void set_size(Camera &camera, unsigned width, unsigned height);

} // namespace opal
