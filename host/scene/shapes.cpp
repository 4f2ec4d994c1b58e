#include "scene/shapes.h"

#include "base/large_vector.h"
#include "shared/types.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

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

Extent TriangleMesh::extent() const {
    Extent extent;
    for (const auto &triangle : triangles)
        for (const Corner &corner : triangle)
            extent.add(positions[corner.position]);
    return extent;
}

TriangleMesh TriangleMesh::moved(const Transform &by) const {
    TriangleMesh mesh = *this;
    for (Vec3 &p : mesh.positions)
        p = by.point(p);
    for (Vec3 &n : mesh.normals)
        n = normalize(by.normal(n));
    return mesh;
}

namespace {

// The entries of an array that one part after another uses, renumbered in the order of their first use.
template <class Entry> class Renumbering {
public:
    explicit Renumbering(const LargeVector<Entry> &all) : all_(all), renumbered_(all.size(), {OPAL_NONE, 0}) {}

    void begin_part() {
        part_++;
        used_.clear();
    }
    void renumber(unsigned &index) {
        if (index == OPAL_NONE)
            return;
        auto &[number, part] = renumbered_[index];
        if (part != part_) {
            number = unsigned(used_.size());
            part = part_;
            used_.push_back(all_[index]);
        }
        index = number;
    }
    LargeVector<Entry> used() const { return used_; }

private:
    const LargeVector<Entry> &all_;
    std::vector<std::pair<unsigned, size_t>> renumbered_; // the new index, and the part that it holds for
    size_t part_ = 0;
    LargeVector<Entry> used_; // by the present part
};

} // namespace

std::vector<TriangleMesh> TriangleMesh::parts(const std::vector<std::vector<size_t>> &lists) const {
    std::vector<TriangleMesh> meshes;
    Renumbering of_positions(positions);
    Renumbering of_normals(normals);
    Renumbering of_uvs(uvs);
    for (const std::vector<size_t> &list : lists) {
        of_positions.begin_part();
        of_normals.begin_part();
        of_uvs.begin_part();
        TriangleMesh &mesh = meshes.emplace_back();
        for (size_t index : list) {
            for (Corner &corner : mesh.triangles.emplace_back(triangles[index])) {
                of_positions.renumber(corner.position);
                of_normals.renumber(corner.normal);
            }
            if (!uv_corners.empty())
                for (unsigned &corner : mesh.uv_corners.emplace_back(uv_corners[index]))
                    of_uvs.renumber(corner);
        }
        mesh.positions = of_positions.used();
        mesh.normals = of_normals.used();
        mesh.uvs = of_uvs.used();
        if (mesh.uvs.empty())
            free_memory(mesh.uv_corners);
    }
    return meshes;
}

std::string TriangleMesh::text() const {
    return fmt::format("{} triangles{}", triangles.size(), uv_corners.empty() ? "" : " with uv");
}

Extent Parallelogram::extent() const {
    Extent extent;
    for (Vec3 corner : corners())
        extent.add(corner);
    return extent;
}

Parallelogram Parallelogram::moved(const Transform &by) const {
    return {by.point(origin), by.vector(u), by.vector(v), uv_exchanged};
}

std::string Parallelogram::text() const { return "parallelogram"; }

Extent Sphere::extent() const {
    const Vec3 half{radius, radius, radius};
    return {center - half, center + half};
}

Sphere Sphere::moved(const Transform &by) const {
    const double determinant = by.determinant();
    Sphere sphere = {by.point(center), radius * std::cbrt(std::abs(determinant)), inward != (determinant < 0), axes};
    for (Vec3 &axis : sphere.axes)
        axis = normalize(by.vector(axis));
    return sphere;
}

std::string Sphere::text() const { return "sphere"; }

std::string why_no_sphere(const Transform &transform) {
    constexpr double rounding = 1e-4; // relative: of files that give a matrix in few digits
    const Vec3 x = transform.vector({1, 0, 0}), y = transform.vector({0, 1, 0}), z = transform.vector({0, 0, 1});
    const double a = length(x), b = length(y), c = length(z), most = std::max({a, b, c});
    if (!std::isfinite(a + b + c) || transform.rows[3] != Transform().rows[3])
        return "no sphere stays a sphere under this matrix";
    if (!(std::abs(transform.determinant()) > rounding * a * b * c))
        return "it is singular: nothing is left of the sphere";
    if (!(std::min({a, b, c}) >= (1 - rounding) * most))
        return fmt::format("it scales a sphere by {:.4g}, {:.4g} and {:.4g} along its axes; possible: the same scale "
                           "along all, or a mesh",
                           a, b, c);
    if (!(std::max({std::abs(dot(x, y)), std::abs(dot(y, z)), std::abs(dot(z, x))}) <= rounding * most * most))
        return "it shears a sphere; possible: rotations, translations and one scale, or a mesh";
    return {};
}

} // namespace opal
