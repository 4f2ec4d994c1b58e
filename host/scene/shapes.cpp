#include "scene/shapes.h"

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

TriangleMesh TriangleMesh::part(const std::vector<size_t> &indices) const {
    TriangleMesh part;
    std::vector<unsigned> new_positions(positions.size(), OPAL_NONE), new_normals(normals.size(), OPAL_NONE),
        new_uvs(uvs.size(), OPAL_NONE);
    // Renumbers an index in the order of first use, and copies what it names.
    const auto renumber = [](unsigned &index, const auto &from, auto &to, std::vector<unsigned> &renumbered) {
        if (index == OPAL_NONE)
            return;
        if (renumbered[index] == OPAL_NONE) {
            renumbered[index] = unsigned(to.size());
            to.push_back(from[index]);
        }
        index = renumbered[index];
    };
    for (size_t index : indices) {
        std::array<Corner, 3> &triangle = part.triangles.emplace_back(triangles[index]);
        for (Corner &corner : triangle) {
            renumber(corner.position, positions, part.positions, new_positions);
            renumber(corner.normal, normals, part.normals, new_normals);
        }
        if (!uv_corners.empty())
            for (unsigned &corner : part.uv_corners.emplace_back(uv_corners[index]))
                renumber(corner, uvs, part.uvs, new_uvs);
    }
    if (part.uvs.empty())
        part.uv_corners.clear();
    return part;
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

Parallelogram Parallelogram::moved(const Transform &by) const { return {by.point(origin), by.vector(u), by.vector(v)}; }

std::string Parallelogram::text() const { return "parallelogram"; }

} // namespace opal
