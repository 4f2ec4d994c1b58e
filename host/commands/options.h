// Options that several commands share: the scene, its strategy overrides, the kernels' sources, the device.
#pragma once

#include "commands/command.h"
#include "device/context.h"
#include "device/sources.h"
#include "read/load.h"

namespace opal {

struct SceneOptions {
    std::filesystem::path file;
    std::map<std::string, std::string> overrides; // for override_strategy: "lighting" -> "mis"
    LoadOptions load;
    std::string cl_dir; // empty: the embedded kernels
};

// --integrator, a flag for each strategy option, --lenient, --dialect, --sensor, -D, --cl-dir.
std::vector<OptionRow> strategy_rows(SceneOptions &options);
// SCENE.xml, then strategy_rows.
std::vector<OptionRow> scene_rows(SceneOptions &options);

struct DeviceOptions {
    std::string name;     // for pick_device
    unsigned threads = 0; // 0: all
};
OptionRow device_row(DeviceOptions &device);  // --device
OptionRow threads_row(DeviceOptions &device); // --threads
DevicePick choose_device(const DeviceOptions &device);

OptionRow cl_dir_row(std::string &cl_dir); // --cl-dir, for load_sources

// Loads the scene, applies the overrides and checks the strategy. Throws Error.
SceneDescription load_scene(const SceneOptions &options);
// The device that renders the scene, and width and math of its kernel.
struct KernelChoice {
    DevicePick pick;
    BuildOptions build;
};
KernelChoice choose_kernel(const DeviceOptions &device, const SceneDescription &scene);

// The kernels' sources in that folder; empty: the embedded ones.
Sources load_sources(const std::string &cl_dir);

OptionRow crop_row(std::string &crop); // --crop, for set_crop
// Sets the camera's crop, "X,Y,W,H", after its size; empty: none. Throws Error if it is no part of the image.
void set_crop(Camera &camera, const std::string &crop);

// Sets the image's size in pixels; 0: not given. If one side is given, the other keeps the aspect.
void set_size(Camera &camera, unsigned width, unsigned height);

} // namespace opal
