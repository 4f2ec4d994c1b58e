// What the host knows of each kind of emitter: functions that flatten/emitter_NAME.cpp defines.
#pragma once

#include "flatten/geometry.h"

namespace opal {

// Of each emitter of the scene:
//   add_extent   adds the points at which it is; an infinite one is nowhere
//   power_of     power that it sheds on the scene, W; radius: of the scene's bounding sphere, world units
//   flattened    its record
#define OPAL_DECLARE_EMITTER(name, traits)                                                                             \
    void add_extent(const emitter_##name &light, Extent &extent);                                                      \
    double power_of(const emitter_##name &light, double radius);                                                       \
    emitter_##name##_record flattened(const emitter_##name &light, const Flattening &flattening);
OPAL_SCENE_EMITTERS(OPAL_DECLARE_EMITTER)

// Sets the axes of a projector's image: unit vectors x, along which it goes to the right, and y, to its bottom.
void store_image_axes(const emitter_projector &light, Vec3 x, Vec3 y, emitter_projector_record &record);
// Fills the table of an environment's texels, and what the record says of it; compensate: may light sampling leave out
// what is dark (emitter_envmap::mis_compensation)?
void flatten_map(const emitter_envmap &light, bool compensate, emitter_envmap_record &record,
                 LargeVector<EnvironmentTexel> &texels);

inline void add_extent(const Light &light, Extent &extent) {
    std::visit([&](const auto &own) { add_extent(own, extent); }, light.parameters);
}
inline double power_of(const Light &light, double radius) {
    return std::visit([&](const auto &own) { return power_of(own, radius); }, light.parameters);
}
// Whether it emits nothing: such a light is left out.
inline bool is_black(const Light &light) { return !(power_of(light, 1) > 0); }

// The triangles of a mesh that emits; a sphere has none.
struct EmittingMesh {
    const Mesh &mesh;
    uint index; // of the mesh
    const Flattening &flattening;
    uint begin, end; // ids of its triangles
    const TriangleSoup &soup;
    const std::vector<uint> &slots; // of each triangle's vertices, by id: block * 8 + place in the block, as in a Hit
    bool uniform_triangles;         // --triangle-choice uniform
};

// The area of a triangle in flattened units, after rounding.
inline double triangle_area(const TriangleSoup &soup, uint id) {
    const auto &[a, b, c] = soup.corners[id];
    return 0.5 * length(normal_of(soup.vertices[a], soup.vertices[b], soup.vertices[c]));
}

// Of each emitter of meshes: fills the record and the emitter's rows of tables. Returns the area in flattened units,
// that of the rounded triangles.
#define OPAL_DECLARE_MESH_EMITTER(name, traits)                                                                        \
    double flatten_##name(const EmittingMesh &from, EmitterRecord &record, FlatScene &scene);
OPAL_MESH_EMITTERS(OPAL_DECLARE_MESH_EMITTER)

} // namespace opal
