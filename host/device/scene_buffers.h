// A flat scene in the device's memory.
#pragma once

#include "device/buffers.h"
#include "flatten/flat_scene.h"

namespace opal {

// On the device, in the order of SCENE_PARAMETERS (cl/scene.cl): the settings, then OPAL_TABLES.
std::vector<cl::Buffer> upload_scene(const Device &device, const FlatScene &scene);

} // namespace opal
