#include "device/scene_buffers.h"

namespace opal {

std::vector<cl::Buffer> upload_scene(const Device &device, const FlatScene &scene) {
    std::vector<cl::Buffer> buffers = {make_table(device, std::vector<Settings>{scene.settings}, "the settings")};
#define OPAL_UPLOAD(record, name, shown) buffers.push_back(share_table(device, scene.name, "the " shown));
    OPAL_TABLES(OPAL_UPLOAD)
#undef OPAL_UPLOAD
    return buffers;
}

} // namespace opal
