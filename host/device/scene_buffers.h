// A flat scene in the device's memory.
#pragma once

#include "device/buffers.h"
#include "flatten/flat_scene.h"

namespace opal {

// In the order of SCENE_PARAMETERS (cl/scene.cl): the settings, then OPAL_TABLES. Where device and host share their
// memory, the tables are not copied: the scene must stay as it is for as long as the buffers are used.
std::vector<cl::Buffer> upload_scene(const Device &device, const FlatScene &scene);

} // namespace opal
