#include "flatten/geometry.h"

#include "base/log.h"
#include "flatten/emitter_kinds.h"
#include "flatten/store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace opal {
namespace {

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

class PrimitiveGatherer {
public:
    // with_uv: are texture coordinates needed?
    PrimitiveGatherer(const Flattening &flattening, bool with_uv, FlatScene &scene)
        : flattening_(flattening), with_uv_(with_uv), scene_(scene) {}

    void add(const Mesh &mesh, uint index) {
        mesh_ = index;
        std::visit([this](const auto &shape) { add_primitives(shape); }, mesh.shape);
    }

    TriangleSoup soup;
    std::size_t dropped = 0;
    uint first_dropped = 0; // the mesh of the first of them

private:
    const Flattening &flattening_;
    const bool with_uv_;
    FlatScene &scene_;
    uint mesh_ = 0; // index of the current one

    void drop() {
        if (dropped++ == 0)
            first_dropped = mesh_;
    }

    // What each kind of shape is to the device.

    void add_primitives(const TriangleMesh &mesh) {
        const uint first_normal = uint(scene_.normals.size() / 3), first = add_vertices(mesh.positions);
        for (Vec3 normal : mesh.normals)
            for (double component : {normal.x, normal.y, normal.z})
                scene_.normals.push_back(float(component));
        for (size_t i = 0; i < mesh.triangles.size(); i++) {
            const auto &triangle = mesh.triangles[i];
            // Interpolation needs three normals: a triangle that lacks one is flat.
            const bool smooth =
                triangle[0].normal != OPAL_NONE && triangle[1].normal != OPAL_NONE && triangle[2].normal != OPAL_NONE;
            std::array<uint, 3> normals{OPAL_NONE, OPAL_NONE, OPAL_NONE};
            for (int k = 0; k < 3 && smooth; k++)
                normals[k] = first_normal + triangle[k].normal;
            add_triangle(first, {triangle[0].position, triangle[1].position, triangle[2].position}, normals,
                         uv_of(mesh, i));
        }
    }

    void add_primitives(const Parallelogram &shape) {
        const uint first = add_vertices(shape.corners());
        TriangleUv lower = {{{0, 0}, {1, 0}, {0, 1}}}, upper = {{{1, 0}, {1, 1}, {0, 1}}};
        if (shape.uv_exchanged)
            for (TriangleUv *uv : {&lower, &upper})
                for (auto &corner : uv->corner)
                    std::swap(corner[0], corner[1]);
        add_triangle(first, {0, 1, 2}, {OPAL_NONE, OPAL_NONE, OPAL_NONE}, lower);
        add_triangle(first, {1, 3, 2}, {OPAL_NONE, OPAL_NONE, OPAL_NONE}, upper);
    }

    // A triangle without texture coordinates has its barycentric ones.
    static TriangleUv uv_of(const TriangleMesh &mesh, size_t triangle) {
        TriangleUv uv = {{{0, 0}, {1, 0}, {0, 1}}};
        if (mesh.uv_corners.empty())
            return uv;
        const std::array<unsigned, 3> &corners = mesh.uv_corners[triangle];
        if (std::ranges::find(corners, OPAL_NONE) == corners.end())
            for (size_t i = 0; i < 3; i++)
                std::ranges::copy(mesh.uvs[corners[i]], uv.corner[i]);
        return uv;
    }

    void add_primitives(const Sphere &sphere) {
        const uint id = SHAPE_sphere << OPAL_SHAPE_SHIFT | uint(scene_.sphere_blocks.size());
        const Point3f center = flattening_(sphere.center);
        SphereBlock block{};
        block.radius[0] = flattening_.distance(sphere.radius);
        if (!has_area(block.radius[0])) {
            drop();
            return;
        }
        block.inward[0] = sphere.inward;
        block.mesh[0] = mesh_;
        block.id[0] = id;
        Box box;
        for (int axis = 0; axis < 3; axis++) {
            block.center[axis][0] = center[axis];
            // The next float holds the end of the box, which is rounded.
            box.lo[axis] = std::nextafter(center[axis] - block.radius[0], -Box::infinity);
            box.hi[axis] = std::nextafter(center[axis] + block.radius[0], Box::infinity);
        }
        scene_.sphere_blocks.push_back(block);
        if (with_uv_) {
            SphereFrame frame{};
            for (size_t i = 0; i < 3; i++)
                store(sphere.axes[i], frame.axis[i]);
            scene_.sphere_frames.push_back(frame);
        }
        soup.others.push_back({id, box, mesh_});
    }

    // Returns the index of the first one.
    uint add_vertices(std::span<const Vec3> positions) {
        const uint first = uint(soup.vertices.size());
        for (Vec3 position : positions)
            soup.vertices.push_back(flattening_(position));
        return first;
    }

    // corners: counted from the vertex `first`
    void add_triangle(uint first, std::array<uint, 3> corners, std::array<uint, 3> normals, const TriangleUv &uv) {
        for (uint &corner : corners)
            corner += first;
        if (!has_normal(soup.vertices[corners[0]], soup.vertices[corners[1]], soup.vertices[corners[2]])) {
            drop();
            return;
        }
        soup.corners.push_back(corners);
        scene_.triangles.push_back({{normals[0], normals[1], normals[2]}, mesh_});
        if (with_uv_)
            scene_.triangle_uvs.push_back(uv);
    }
};

} // namespace

Extent extent_of(const Mesh &mesh) {
    return std::visit([](const auto &shape) { return shape.extent(); }, mesh.shape);
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

Flattening find_flattening(const Extent &extent) {
    if (extent.empty())
        return {};
    const Vec3 center = extent.middle();
    int exponent; // half side = m 2^exponent, m in [0.5, 1)
    const double m = std::frexp(extent.longest_side() / 2, &exponent);
    if (m == 0)
        return {center, 1};
    return {center, std::ldexp(1.0, m == 0.5 ? 1 - exponent : -exponent)};
}

TriangleSoup gather_primitives(const SceneDescription &description, const Flattening &flattening, FlatScene &scene,
                               const std::function<void(uint)> &on_gathered) {
    const bool with_uv = needs_uv(description);
    PrimitiveGatherer gatherer(flattening, with_uv, scene);
    std::size_t vertices = 0, normals = 0, triangles = 0;
    for (const Mesh &mesh : description.meshes)
        if (const auto *shape = std::get_if<TriangleMesh>(&mesh.shape)) {
            vertices += shape->positions.size();
            normals += shape->normals.size();
            triangles += shape->triangles.size();
        }
    gatherer.soup.vertices.reserve(vertices);
    gatherer.soup.corners.reserve(triangles);
    scene.normals.reserve(3 * normals);
    scene.triangles.reserve(triangles);
    scene.triangle_uvs.reserve(with_uv ? triangles : 0);
    for (uint mesh = 0; mesh < description.meshes.size(); mesh++) {
        gatherer.add(description.meshes[mesh], mesh);
        on_gathered(mesh);
    }
    if (gatherer.dropped > 0) {
        const Mesh &first = description.meshes[gatherer.first_dropped];
        warn(fmt::format(
            "{}{} of {} {} dropped: no area is left of them in single precision, which rounds "
            "coordinates to {:.0e} of the scene's size; the first is one of {}",
            first.place.line ? first.place.text() + ": " : "", gatherer.dropped,
            gatherer.soup.corners.size() + gatherer.soup.others.size() + gatherer.dropped,
            std::holds_alternative<Sphere>(first.shape) || !gatherer.soup.others.empty() ? "triangles and spheres"
                                                                                         : "triangles",
            std::numeric_limits<float>::epsilon() / 2, first.name.empty() ? "a mesh without a name" : first.name));
    }
    return std::move(gatherer.soup);
}

} // namespace opal
