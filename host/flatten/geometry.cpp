#include "flatten/geometry.h"

#include "base/log.h"
#include "flatten/emitter_kinds.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace opal {
namespace {

std::array<Vec3, 4> corners_of(const Parallelogram &p) {
    return {p.origin, p.origin + p.u, p.origin + p.v, p.origin + p.u + p.v};
}

void add_extent(const Parallelogram &shape, Extent &extent) {
    for (Vec3 corner : corners_of(shape))
        extent.add(corner);
}
void add_extent(const TriangleMesh &shape, Extent &extent) {
    for (const auto &triangle : shape.triangles)
        for (const auto &corner : triangle)
            extent.add(shape.positions[corner.position]);
}

// Whether a device computes the direction of the normal in float: the squared length must not be denormal, in float nor
// in exact arithmetic.
bool has_normal(const Point3f &a, const Point3f &b, const Point3f &c) {
    const Vec3 exact = normal_of(a, b, c);
    const float x = b[0] - a[0], y = b[1] - a[1], z = b[2] - a[2];
    const float u = c[0] - a[0], v = c[1] - a[1], w = c[2] - a[2];
    const float nx = y * w - z * v, ny = z * u - x * w, nz = x * v - y * u;
    constexpr float least = std::numeric_limits<float>::min();
    return nx * nx + ny * ny + nz * nz >= least && dot(exact, exact) >= double(least);
}

class TriangleGatherer {
public:
    TriangleGatherer(const Flattening &flattening, FlatScene &scene) : flattening_(flattening), scene_(scene) {}

    void add(const TriangleMesh &mesh) {
        const uint first_normal = uint(scene_.normals.size() / 3);
        base_ = uint(soup.vertices.size());
        for (Vec3 position : mesh.positions)
            soup.vertices.push_back(flattening_(position));
        for (Vec3 normal : mesh.normals)
            for (double component : {normal.x, normal.y, normal.z})
                scene_.normals.push_back(float(component));
        for (const auto &triangle : mesh.triangles) {
            // Interpolation needs three normals: a triangle that lacks one is flat.
            const bool smooth =
                triangle[0].normal != OPAL_NONE && triangle[1].normal != OPAL_NONE && triangle[2].normal != OPAL_NONE;
            std::array<uint, 3> normals{OPAL_NONE, OPAL_NONE, OPAL_NONE};
            for (int i = 0; i < 3 && smooth; i++)
                normals[i] = first_normal + triangle[i].normal;
            add_triangle({triangle[0].position, triangle[1].position, triangle[2].position}, normals);
        }
        mesh_index_++;
    }

    void add(const Parallelogram &shape) {
        base_ = uint(soup.vertices.size());
        for (Vec3 corner : corners_of(shape))
            soup.vertices.push_back(flattening_(corner));
        add_triangle({0, 1, 2}, {OPAL_NONE, OPAL_NONE, OPAL_NONE});
        add_triangle({1, 3, 2}, {OPAL_NONE, OPAL_NONE, OPAL_NONE});
        mesh_index_++;
    }

    TriangleSoup soup;
    std::size_t dropped = 0;

private:
    const Flattening &flattening_;
    FlatScene &scene_;
    uint base_ = 0, mesh_index_ = 0; // of the current mesh: its first vertex in the soup, and its index

    void add_triangle(std::array<uint, 3> corners, std::array<uint, 3> normals) {
        for (uint &corner : corners)
            corner += base_;
        if (!has_normal(soup.vertices[corners[0]], soup.vertices[corners[1]], soup.vertices[corners[2]])) {
            dropped++;
            return;
        }
        soup.corners.push_back(corners);
        scene_.triangles.push_back({{normals[0], normals[1], normals[2]}, mesh_index_});
    }
};

} // namespace

void Extent::add(Vec3 p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
}

void Extent::add(const Extent &other) {
    add(other.lo);
    add(other.hi);
}

double Extent::longest_side() const { return empty() ? 0 : std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z}); }

double Extent::radius() const { return empty() ? 0 : length(hi - lo) / 2; }

Extent extent_of(const Mesh &mesh) {
    Extent extent;
    std::visit([&](const auto &shape) { add_extent(shape, extent); }, mesh.shape);
    return extent;
}

Extent extent_of(const SceneDescription &scene) {
    Extent extent;
    for (const Mesh &mesh : scene.meshes)
        if (const Extent part = extent_of(mesh); !part.empty())
            extent.add(part);
    for (const Light &light : scene.lights)
        add_extent(light, extent);
    return extent;
}

Point3f Flattening::operator()(Vec3 world) const {
    const Vec3 p = (world - center) * scale;
    return {float(p.x), float(p.y), float(p.z)};
}

Flattening find_flattening(const SceneDescription &scene) {
    const Extent extent = extent_of(scene);
    if (extent.empty())
        return {};
    const Vec3 center = extent.middle();
    int exponent; // half side = m 2^exponent, m in [0.5, 1)
    const double m = std::frexp(extent.longest_side() / 2, &exponent);
    if (m == 0)
        return {center, 1};
    return {center, std::ldexp(1.0, m == 0.5 ? 1 - exponent : -exponent)};
}

TriangleSoup gather_triangles(const SceneDescription &description, const Flattening &flattening, FlatScene &scene) {
    TriangleGatherer gatherer(flattening, scene);
    std::size_t vertices = 0, triangles = 0;
    for (const Mesh &mesh : description.meshes) {
        const auto *mesh_shape = std::get_if<TriangleMesh>(&mesh.shape);
        vertices += mesh_shape ? mesh_shape->positions.size() : 4;
        triangles += mesh_shape ? mesh_shape->triangles.size() : 2;
    }
    gatherer.soup.vertices.reserve(vertices);
    gatherer.soup.corners.reserve(triangles);
    scene.triangles.reserve(triangles);
    for (const Mesh &mesh : description.meshes)
        std::visit([&](const auto &shape) { gatherer.add(shape); }, mesh.shape);
    if (gatherer.dropped > 0)
        warn(fmt::format("{} of {} triangles dropped: no area is left of them in single precision", gatherer.dropped,
                         triangles));
    return std::move(gatherer.soup);
}

} // namespace opal
