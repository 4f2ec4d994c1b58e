#include "read/mitsuba/meshes.h"

#include "base/error.h"
#include "read/mesh_parts.h"
#include "shared/types.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace opal::mitsuba {

namespace {

using Corner = TriangleMesh::Corner;

// A sum of faces' normals at a vertex, each times the face's angle there.
struct VertexNormal {
    Vec3 sum;
    double angles = 0;
    unsigned index = OPAL_NONE; // of the mesh's normals
};

// Below this share of the angles what is left of a sum is rounding in single precision, in which files and Mitsuba
// have their coordinates: faces lie back to back. The corner then gets its face's normal.
constexpr double least_share = 1e-6;

double angle_between(Vec3 a, Vec3 b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

// Have all corners of each position the same uv, as where the file is a list of vertices?
bool has_one_uv_a_position(const TriangleMesh &mesh) {
    LargeVector<unsigned> uvs(mesh.positions.size(), OPAL_NONE);
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (unsigned i = 0; i < 3; ++i) {
            unsigned &uv = uvs[mesh.triangles[t][i].position];
            if (uv != OPAL_NONE && uv != mesh.uv_corners[t][i])
                return false;
            uv = mesh.uv_corners[t][i];
        }
    return true;
}

// For each corner the number of its vertex, where corners of one position are different vertices if their uv are.
LargeVector<std::array<unsigned, 3>> split_by_uv(const TriangleMesh &mesh, size_t &vertex_count) {
    struct Use {
        unsigned position, uv;
        size_t corner; // 3 * triangle + i
    };
    LargeVector<Use> uses;
    uses.reserve(3 * mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (unsigned i = 0; i < 3; ++i)
            uses.push_back({mesh.triangles[t][i].position, mesh.uv_corners[t][i], 3 * t + i});
    const auto key = [](const Use &use) { return uint64_t(use.position) << 32 | use.uv; };
    std::sort(uses.begin(), uses.end(), [&](const Use &a, const Use &b) { return key(a) < key(b); });
    LargeVector<std::array<unsigned, 3>> vertices(mesh.triangles.size());
    vertex_count = 0;
    for (size_t i = 0; i < uses.size(); ++i) {
        vertex_count += i == 0 || key(uses[i]) != key(uses[i - 1]);
        vertices[uses[i].corner / 3][uses[i].corner % 3] = unsigned(vertex_count - 1);
    }
    return vertices;
}

// Smooth normals (Thuermer and Wuethrich 1998).
void add_smooth_normals(TriangleMesh &mesh) {
    size_t vertex_count = mesh.positions.size();
    LargeVector<std::array<unsigned, 3>> split;
    if (!mesh.uv_corners.empty() && !has_one_uv_a_position(mesh))
        split = split_by_uv(mesh, vertex_count);
    const auto vertex_of = [&](size_t t, unsigned i) {
        return split.empty() ? mesh.triangles[t][i].position : split[t][i];
    };
    LargeVector<VertexNormal> vertices(vertex_count);
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<Vec3, 3> p;
        for (unsigned i = 0; i < 3; ++i)
            p[i] = mesh.positions[mesh.triangles[t][i].position];
        const Vec3 normal = normalize(cross(p[1] - p[0], p[2] - p[0]));
        for (unsigned i = 0; i < 3; ++i) {
            const double angle = angle_between(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
            VertexNormal &vertex = vertices[vertex_of(t, i)];
            vertex.sum = vertex.sum + normal * angle;
            vertex.angles += angle;
        }
    }
    for (VertexNormal &vertex : vertices)
        if (const double size = length(vertex.sum); size > least_share * vertex.angles) {
            vertex.index = unsigned(mesh.normals.size());
            mesh.normals.push_back(vertex.sum * (1 / size));
        }
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        for (unsigned i = 0; i < 3; ++i)
            mesh.triangles[t][i].normal = vertices[vertex_of(t, i)].index;
}

// Corners in the other order, each with its uv.
void reverse_winding(TriangleMesh &mesh) {
    for (auto &triangle : mesh.triangles)
        std::swap(triangle[1], triangle[2]);
    for (auto &corners : mesh.uv_corners)
        std::swap(corners[1], corners[2]);
}

// As in Mitsuba, corners of a side are in the order of these uv, and these are its two triangles.
constexpr std::array<std::array<float, 2>, 4> cube_uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
constexpr unsigned cube_triangles[2][3] = {{0, 1, 2}, {3, 0, 2}};
constexpr double cube_sides[6][4][3] = {
    {{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}}, {{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}},
    {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},     {{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}},
    {{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}}, {{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}};

} // namespace

TriangleMesh finished_mesh(TriangleMesh mesh, const MeshOptions &options) {
    if (options.face_normals) {
        free_memory(mesh.normals);
        for (auto &triangle : mesh.triangles)
            for (Corner &corner : triangle)
                corner.normal = OPAL_NONE;
    } else if (mesh.normals.empty()) {
        add_smooth_normals(mesh);
    }
    if (options.flip_tex_coords)
        for (auto &[u, v] : mesh.uvs)
            v = 1 - v;
    if (options.flip_normals) {
        if (mesh.uv_corners.empty()) { // the barycentric ones of the corners before they change places
            mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
            mesh.uv_corners.assign(mesh.triangles.size(), {0, 1, 2});
        }
        reverse_winding(mesh);
        for (Vec3 &normal : mesh.normals)
            normal = normal * -1;
    }
    return mesh;
}

Parallelogram rectangle(const Transform &to_world, bool flip_normals) {
    Parallelogram shape = Parallelogram{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}.moved(to_world);
    const std::array<Vec3, 3> half = {shape.origin, shape.origin + shape.u, shape.origin + shape.v};
    if (!fits_float(half[0]) || !fits_float(half[1]) || !fits_float(half[2]) || !has_area(half, rounding_of(half)))
        throw Error("to_world leaves the rectangle no area, or makes it infinite");
    // u x v is the image of +z times the determinant.
    if ((to_world.determinant() < 0) != flip_normals)
        shape = {shape.origin, shape.v, shape.u, true};
    return shape;
}

TriangleMesh cube(const Transform &to_world, bool flip_normals) {
    TriangleMesh mesh;
    for (const auto &side : cube_sides) {
        const unsigned first = unsigned(mesh.positions.size());
        for (const auto &[x, y, z] : side) {
            mesh.positions.push_back(to_world.point({x, y, z}));
            if (!fits_float(mesh.positions.back()))
                throw Error("to_world makes the cube infinite");
        }
        mesh.uvs.insert(mesh.uvs.end(), cube_uvs.begin(), cube_uvs.end());
        for (const auto &[a, b, c] : cube_triangles) {
            mesh.triangles.push_back({{{first + a, OPAL_NONE}, {first + b, OPAL_NONE}, {first + c, OPAL_NONE}}});
            mesh.uv_corners.push_back({first + a, first + b, first + c});
            const std::array<Vec3, 3> p = {mesh.positions[first + a], mesh.positions[first + b],
                                           mesh.positions[first + c]};
            if (!has_area(p, rounding_of(p)))
                throw Error("to_world leaves a side of the cube no area");
        }
    }
    if ((to_world.determinant() < 0) != flip_normals)
        reverse_winding(mesh);
    return mesh;
}

} // namespace opal::mitsuba
