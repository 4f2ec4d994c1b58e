#include "fuzz/oracles.h"

#include "bvh/bvh.h"
#include "fuzz/harness.h"

#include <algorithm>
#include <cmath>

namespace opal::fuzz {

namespace {

bool is_finite(Vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

template <class Numbers> bool all_finite(const Numbers &numbers) {
    return std::ranges::all_of(numbers, [](float x) { return std::isfinite(x); });
}

bool is_share(float x) { return x >= 0 && x <= 1; }

// The primitives that were met, by shape and index.
using Met = std::array<std::vector<bool>, SHAPE_COUNT>;

// Marks the primitives of a block; unused places come last.
void mark_ids(const uint (&ids)[OPAL_WIDTH], int shape, Met &met) {
    bool ended = false;
    for (const uint id : ids) {
        ended = ended || id == OPAL_NONE;
        require(ended == (id == OPAL_NONE), "unused places of a block come last");
        if (ended)
            continue;
        require(shape_of(id) == uint(shape), "ids in a block are of its shape");
        const uint index = id & OPAL_BLOCK_BITS;
        require(index < met[shape].size(), "ids in a block are those of primitives");
        met[shape][index] = true;
    }
}

template <class Row> void check_around_0(const Row &row) {
    require(std::ranges::all_of(row, [](float x) { return std::abs(x) <= 2; }), "positions lie around 0");
}

void mark(const TriangleBlock &block, Met &met) {
    mark_ids(block.id, SHAPE_triangle, met);
    for (const auto &corner : block.vertex)
        for (const auto &axis : corner)
            check_around_0(axis);
}

void mark(const SphereBlock &block, Met &met) {
    mark_ids(block.id, SHAPE_sphere, met);
    for (const auto &axis : block.center)
        check_around_0(axis);
    check_around_0(block.radius);
    require(std::ranges::all_of(block.radius, [](float r) { return r > 0; }), "spheres have a size");
}

// Marks the primitives in the leaves below the root.
void check_tree(const FlatScene &scene, Met &met) {
    Bvh tree;
    tree.nodes = scene.nodes;
    require(levels_of(tree) <= OPAL_LEVELS, "a tree has at most OPAL_LEVELS levels");
    std::vector<bool> node_met(scene.nodes.size());
    Met leaf_met;
    leaf_met[SHAPE_triangle].resize(scene.triangle_blocks.size());
    leaf_met[SHAPE_sphere].resize(scene.sphere_blocks.size());
    std::vector<uint> left{0};
    while (!left.empty()) {
        const uint index = left.back();
        left.pop_back();
        require(index < scene.nodes.size() && !node_met[index], "each node is met once");
        node_met[index] = true;
        const BvhNode &node = scene.nodes[index];
        bool ended = false;
        for (int place = 0; place < OPAL_WIDTH; place++) {
            const uint child = node.child[place];
            ended = ended || child == OPAL_NONE;
            require(ended == (child == OPAL_NONE), "unused children come last");
            if (ended)
                continue;
            if (child & OPAL_LEAF) {
                const uint block = child & OPAL_BLOCK_BITS;
                const uint shape = shape_of(child & ~OPAL_LEAF);
                require(shape < SHAPE_COUNT, "leaves have a shape");
                require(shape != SHAPE_triangle || block < scene.settings.face_list_slot / OPAL_WIDTH ||
                            scene.faces.empty(),
                        "listed, not in a leaf");
                require(block < leaf_met[shape].size() && !leaf_met[shape][block], "each leaf is met once");
                leaf_met[shape][block] = true;
                if (shape == SHAPE_triangle)
                    mark(scene.triangle_blocks[block], met);
                else
                    mark(scene.sphere_blocks[block], met);
                continue;
            }
            require(child < scene.nodes.size(), "children are nodes");
            const BvhNode &below = scene.nodes[child];
            for (int i = 0; i < OPAL_WIDTH && below.child[i] != OPAL_NONE; i++)
                for (int axis = 0; axis < 3; axis++)
                    require(below.lo[axis][i] >= node.lo[axis][place] && below.hi[axis][i] <= node.hi[axis][place],
                            "boxes of children lie in those of their parents");
            left.push_back(child);
        }
    }
    require(std::ranges::all_of(node_met, std::identity()), "all nodes are met");
}

void check_face_list(const FlatScene &scene, std::vector<bool> &met) {
    const Settings &settings = scene.settings;
    require(settings.face_list.faces == scene.faces.size() &&
                3 * size_t(settings.face_list.vertices) == scene.face_vertices.size(),
            "the face list's range is all of it");
    require(settings.face_list_to_light.faces <= settings.face_list.faces &&
                settings.face_list_to_light.vertices <= settings.face_list.vertices,
            "faces that may occlude lights are some of all");
    require(settings.face_list.vertices <= OPAL_FACE_LIST_VERTICES, "a face list has few vertices");
    for (const FaceRecord &face : scene.faces) {
        require(std::ranges::all_of(face.corner, [&](uint c) { return c < settings.face_list.vertices; }),
                "corners of listed faces are vertices");
        require(all_finite(face.normal) && std::isfinite(face.along), "planes of faces are finite");
    }
    if (!scene.faces.empty())
        for (size_t block = settings.face_list_slot / OPAL_WIDTH; block < scene.triangle_blocks.size(); block++)
            for (const uint id : scene.triangle_blocks[block].id)
                if (id != OPAL_NONE) {
                    require(id < met.size(), "ids of listed faces are those of triangles");
                    met[id] = true;
                }
}

void check_materials(const FlatScene &scene) {
    for (const Triangle &triangle : scene.triangles) {
        require(triangle.mesh < scene.meshes.size(), "a triangle's mesh is one");
        for (const uint normal : triangle.normal)
            require(normal == OPAL_NONE || 3 * size_t(normal) + 2 < scene.normals.size(), "a corner's normal is one");
    }
    require(all_finite(scene.normals), "normals are finite");
    for (const MeshRecord &mesh : scene.meshes) {
        require(mesh.emitter == OPAL_NONE || mesh.emitter < scene.emitters.size(), "a mesh's emitter is one");
        visit_bsdfs(scene, mesh.bsdf, [&](uint at) {
            require(at < scene.bsdfs.size() && scene.bsdfs[at] < BSDF_COUNT, "a material is the record of a kind");
        });
    }
}

// A table's row is drawn with its probability: the shares of its own row and of others' sum to it, and all to one.
constexpr double sum_tolerance = 1e-4; // of single precision, over the tables' lengths

void check_emitters(const FlatScene &scene) {
    require(scene.settings.emitter_count == scene.emitters.size(), "emitter_count is the number of emitters");
    require(scene.settings.environment == OPAL_NONE || scene.settings.environment < scene.emitters.size(),
            "the environment is an emitter");
    double sum = 0;
    for (const EmitterRecord &emitter : scene.emitters) {
        require(emitter.kind < EMITTER_COUNT && emitter.other < scene.emitters.size(), "a row's other emitter is one");
        require(is_share(emitter.probability) && is_share(emitter.accept), "probabilities are from 0 to 1");
        sum += emitter.probability;
        if (emitter.kind != EMITTER_mesh)
            continue;
        require(emitter.count > 0 && size_t(emitter.first) + emitter.count <= scene.light_triangles.size(),
                "a mesh's rows are in the table");
        for (uint i = emitter.first; i < emitter.first + emitter.count; i++) {
            const LightTriangle &row = scene.light_triangles[i];
            require(row.other < emitter.count && is_share(row.accept), "rows of a mesh lead to its rows");
            require(row.slot / OPAL_WIDTH < scene.triangle_blocks.size() &&
                        scene.triangle_blocks[row.slot / OPAL_WIDTH].id[row.slot % OPAL_WIDTH] < scene.triangles.size(),
                    "a light's triangle is in a block");
            require(row.inverse_pdf >= 0 && std::isfinite(row.inverse_pdf), "densities on lights are positive");
        }
    }
    require(scene.emitters.empty() || std::abs(sum - 1) <= sum_tolerance, "probabilities of emitters sum to 1");
}

} // namespace

void check(const TriangleMesh &mesh) {
    for (const Vec3 &p : mesh.positions)
        require(is_finite(p), "positions are finite");
    for (const Vec3 &n : mesh.normals)
        require(std::abs(length(n) - 1) < 1e-6, "normals have unit length");
    for (const auto &triangle : mesh.triangles)
        for (const TriangleMesh::Corner &corner : triangle) {
            require(corner.position < mesh.positions.size(), "corners are positions");
            require(corner.normal == OPAL_NONE || corner.normal < mesh.normals.size(), "a corner's normal is one");
        }
    require(mesh.uv_corners.empty() || mesh.uv_corners.size() == mesh.triangles.size(), "uvs are for all triangles");
    for (const auto &triangle : mesh.uv_corners)
        for (const unsigned uv : triangle)
            require(uv == OPAL_NONE || uv < mesh.uvs.size(), "a corner's uv is one");
    for (const auto &attribute : mesh.attributes) {
        const size_t owners = attribute->of_faces ? mesh.triangles.size() : mesh.positions.size();
        require(attribute->values.size() == owners * size_t(attribute->channels), "attributes have all values");
        require(all_finite(attribute->values), "attributes are finite");
    }
}

bool has_finite_lights(const FlatScene &scene) {
    return std::ranges::all_of(scene.emitters, [](const EmitterRecord &e) { return all_finite(e.u.color); });
}

void check(const FlatScene &scene) {
    size_t spheres = 0;
    for (const SphereBlock &block : scene.sphere_blocks)
        spheres += size_t(std::ranges::count_if(block.id, [](uint id) { return id != OPAL_NONE; }));
    Met met{std::vector<bool>(scene.triangles.size()), std::vector<bool>(spheres)};
    if (!scene.nodes.empty())
        check_tree(scene, met);
    check_face_list(scene, met[SHAPE_triangle]);
    for (const std::vector<bool> &of_shape : met)
        require(std::ranges::all_of(of_shape, std::identity()), "every primitive is in a block");
    require(std::isfinite(scene.scale) && scene.scale > 0 && is_finite(scene.center), "the map of positions is finite");
    check_materials(scene);
    check_emitters(scene);
}

} // namespace opal::fuzz
