#include "device/scene_buffers.h"

namespace opal {

std::vector<cl::Buffer> upload_scene(const Device &device, const FlatScene &s) {
    return {make_table(device, std::vector<Settings>{s.settings}, "the settings"),
            make_table(device, s.nodes, "the tree's nodes"),
            make_table(device, s.blocks, "the triangles"),
            make_table(device, s.triangles, "the triangles' attributes"),
            make_table(device, s.normals, "the normals"),
            make_table(device, s.face_vertices, "the listed vertices"),
            make_table(device, s.faces, "the listed faces"),
            make_table(device, s.meshes, "the meshes"),
            make_table(device, s.bsdfs, "the BSDFs"),
            make_table(device, s.emitters, "the emitters"),
            make_table(device, s.light_triangles, "the light triangles")};
}

} // namespace opal
