// A scene as the device sees it: arrays of shared records, and the features that its kernel needs.
#pragma once

#include "base/math.h"
#include "bsdfs/list.h"
#include "emitters/list.h"
#include "kernels/features.h"
#include "scene/scene.h"
#include "shared/types.h"

#include <string>
#include <vector>

namespace opal {

struct Feature {
    std::string name; // "tree" -> OPAL_HAS_tree
    bool on = false;
    std::string reason; // "36 triangles: each against all lanes is faster"
};

// What decides the program text (DESIGN section 4): features as 0 or 1, axes as a CHOICE_* or -1 (decided at run time).
struct Features {
    std::vector<Feature> list;          // in the order of OPAL_FEATURES
    std::array<int, AXIS_COUNT> axes{}; // CHOICE_* or -1
    std::array<std::string, AXIS_COUNT> axis_reasons;
    bool operator[](std::string_view name) const;
};

struct FlatScene {
    // Flattened position = (world position - center) * scale; scale is a power of two, so that nothing but the
    // recentring rounds. Everything then lies within about [-1, 1], whatever the scene's units.
    Vec3 center;
    double scale = 1;

    Settings settings{};
    std::vector<BvhNode> nodes; // empty: no tree
    std::vector<TriangleBlock> blocks;
    std::vector<Triangle> triangles;
    std::vector<float> normals;       // 3 each
    std::vector<float> face_vertices; // 3 each, distinct
    std::vector<FaceRecord> faces;    // beside the tree
    uint face_list_triangles = 0;     // that these faces stand for
    std::vector<MeshRecord> meshes;
    std::vector<BsdfRecord> bsdfs; // equal records are shared
    std::vector<EmitterRecord> emitters;
    std::vector<LightTriangle> light_triangles;
    Features features;

    double sah_cost = 0; // of the tree, in triangle block tests and node visits
    double bvh_seconds = 0;
};

// lanes: the width that the kernel will have; decides whether triangles are listed beside the tree.
FlatScene flatten(const SceneDescription &scene, int lanes);

} // namespace opal
