// A scene as the device sees it: arrays of shared records, and the features that its kernel needs.
#pragma once

#include "base/crop.h"
#include "base/large_vector.h"
#include "base/math.h"
#include "emitters/list.h"
#include "kernels/features.h"
#include "scene/scene.h"
#include "scene_tables.h"
#include "shared/types.h"

#include <array>
#include <string>
#include <vector>

namespace opal {

struct Feature {
    bool on = false;
    std::string reason; // "36 triangles: each against all lanes is faster"
};

// The decisions that a kernel is compiled with: each feature as 0 or 1, each strategy axis as a CHOICE_* or as -1,
// decided at run time.
struct Features {
    std::array<Feature, FEATURE_COUNT> list; // by FEATURE_*
    std::array<uint, BSDF_COUNT> textured{}; // by BSDF_*: the parameters that have a texture, a bit each in their order
    uint perturbations = 0;                  // the most BSDFs of a nest that change the shading normal
    std::array<uint, BSDF_COUNT> nonzero{};  // by BSDF_*: those that may be other than 0, of kinds of OPAL_MANY_LOBES
    uint texture_kinds = 0;                  // of the scene's textures, bit TEXTURE_* each
    uint bitmap_forms = 0;                   // of its bitmaps: BITMAP_*
    std::string loop = "render";             // the kernel file that drives the integrator
    std::array<int, AXIS_COUNT> axes{};      // CHOICE_* or -1
    std::array<std::string, AXIS_COUNT> axis_reasons;
    bool operator[](unsigned feature) const { return list[feature].on; }
};

struct FlatScene {
    // Flattened position = (world position - center) * scale: positions lie within about [-1, 1], whatever the scene's
    // units. See Flattening (flatten/geometry.h).
    Vec3 center;
    double scale = 1;

    Settings settings{};
    Crop crop; // what is shown of the image: settings.film less what the filter needs around it
#define OPAL_TABLE_ROWS(record, name, shown) LargeVector<record> name;
    OPAL_TABLES(OPAL_TABLE_ROWS)
#undef OPAL_TABLE_ROWS
    uint texture_kinds = 0, bitmap_forms = 0; // as in Features, of the table of textures
    uint face_list_triangles = 0;             // that `faces` stand for
    Features features;

    double sah_cost = 0;    // of the tree, in triangle block tests and node visits
    double bvh_seconds = 0; // wall time of the build

    std::size_t tree_bytes() const; // of the nodes and of all shapes' blocks
};

// Calls visit(at) for the record of a mesh's BSDF and those that it leads to; at: the first word in scene.bsdfs.
template <class Visit> void visit_bsdfs(const FlatScene &scene, uint at, Visit visit) {
    visit(at);
    for (const Parameter &parameter : bsdf_parameters(scene.bsdfs[at]))
        if (parameter.type == ParameterType::BSDF)
            visit_bsdfs(scene, scene.bsdfs[at + parameter.word], visit);
}

// Does the pixel filter reach beyond its pixel?
inline bool is_wide_filter(const Settings &settings) {
    return settings.filter != FILTER_box || settings.filter_radius > 0.5f;
}

// lanes: the width that the kernel will have; decides whether triangles are listed beside the tree.
// with_face_list: may they be? Tests of the tree say no.
FlatScene flatten(const SceneDescription &scene, int lanes, bool with_face_list = true);

// The same of a scene that is flattened once: each triangle mesh and picture is freed as soon as it is gathered, and
// left empty; a picture keeps its size.
FlatScene flatten_and_free(SceneDescription &scene, int lanes);

} // namespace opal
